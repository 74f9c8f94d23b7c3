// Product of two digits for the accumulator: a_i b_i, or its negative, as two words: sum_o + carry_o modulo 2**Width.
//
// a_i and b_i are in two's complement. Structural kinds use radix-4 Booth recoding of b_i (without the top digit, which
// only an unsigned b_i needs) and a carry-save tree; the adder is in exact_accumulator. A row of DigitWidth + 1 bits in
// two's complement equals the row with its top bit inverted, less 2**DigitWidth. These corrections add up to a
// constant. It shares a row of the tree with the +1 of each complemented row. Combinational.
module exact_product #(
  parameter int unsigned DigitWidth = 48,
  parameter int unsigned Width = 103,
  parameter int unsigned Arith = arith_pkg::Graded
) (
  input  logic [DigitWidth-1:0] a_i,
  input  logic [DigitWidth-1:0] b_i,
  input  logic                  negate_i,
  output logic [Width-1:0]      sum_o,
  output logic [Width-1:0]      carry_o
);

  if (DigitWidth % 2 != 0 || Width < 2 * DigitWidth) begin : gen_check
    $error("exact_product: expected an even DigitWidth and a Width of 2 DigitWidth or more");
  end

  if (Arith == arith_pkg::Behavioural) begin : gen_behavioural
    assign sum_o   = (Width'($signed(a_i)) * Width'($signed(b_i))) ^ {Width{negate_i}};
    assign carry_o = Width'(negate_i);
  end else begin : gen_booth
    localparam int unsigned Rows = DigitWidth / 2;
    localparam logic [Width-1:0] Ones = Width'({Rows{2'b01}});
    localparam logic [Width-1:0] Signs = (~Ones + 1'b1) << DigitWidth;

    // verilator lint_off UNUSEDSIGNAL
    // Odd bits belong to no digit; the last digit is for unsigned numbers only.
    logic [DigitWidth+1:0] one, two, negative;
    // verilator lint_on UNUSEDSIGNAL
    logic [DigitWidth-1:0] turned;
    logic [Width*(Rows+1)-1:0] rows;

    booth_encoder #(
      .Width(DigitWidth)
    ) u_encoder (
      .b_i,
      .one_o     (one),
      .two_o     (two),
      .negative_o(negative)
    );

    assign turned = (negative[DigitWidth-1:0] ^ {DigitWidth{negate_i}}) & Ones[DigitWidth-1:0];

    for (genvar k = 0; k < Rows; k++) begin : gen_row
      logic [DigitWidth:0] once, twice, row;

      assign once  = {a_i[DigitWidth-1], a_i} & {(DigitWidth + 1) {one[2*k]}};
      assign twice = {a_i, 1'b0} & {(DigitWidth + 1) {two[2*k]}};
      assign row   = (once | twice) ^ {(DigitWidth + 1) {turned[2*k]}};
      assign rows[Width*k+:Width] = Width'({~row[DigitWidth], row[DigitWidth-1:0]}) << 2 * k;
    end
    assign rows[Width*Rows+:Width] = Signs | Width'(turned);

    carry_save_tree #(
      .Width(Width),
      .Rows (Rows + 1)
    ) u_tree (
      .rows_i (rows),
      .sum_o,
      .carry_o
    );
  end

endmodule
