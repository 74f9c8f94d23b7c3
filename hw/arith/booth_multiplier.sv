// Unsigned multiplier: product_o = a_i * b_i.
//
// The paper's multiplier (section 3.4) for any Width from 2: radix-4 Booth recoding of b_i (13 partial products for 24
// bits), constants in place of sign extension, a carry-save tree, and an adder of 2 * Width bits.
//
// ConstantRow = 1 gives the constants a row of their own, as in the paper (14 rows, 12 adders in 6 levels). 0 puts them
// into free places of the other rows (13 rows, 11 adders in 5 levels). Arith (a structural kind), GroupWidths and
// LookAhead configure the adder: see adder. Combinational.
module booth_multiplier #(
  parameter int unsigned Width = 24,
  parameter int unsigned Arith = arith_pkg::Graded,
  parameter bit [8*arith_pkg::MaxGroups-1:0] GroupWidths = '0,
  parameter bit LookAhead = 1'b1,
  parameter bit ConstantRow = 1'b0
) (
  input  logic [Width-1:0]   a_i,
  input  logic [Width-1:0]   b_i,
  output logic [2*Width-1:0] product_o
);

  localparam int unsigned Digits = Width / 2 + 1;
  localparam int unsigned Rows = ConstantRow ? Digits + 1 : Digits;

  if (Width < 2) begin : gen_check
    $error("booth_multiplier: expected a Width of 2 or more");
  end

  // Recode: digit k at bit 2k of each word

  // verilator lint_off UNUSEDSIGNAL
  // The odd bits belong to no digit.
  logic [2*Digits-1:0] one, two, negative;
  // verilator lint_on UNUSEDSIGNAL

  booth_encoder #(
    .Width(Width)
  ) u_encoder (
    .b_i,
    .one_o     (one),
    .two_o     (two),
    .negative_o(negative)
  );

  // Partial products: row k has weight 4**k
  //
  // Let n be the word `negative`. The product is the sum of the rows plus n - n * 2**(Width+1): see booth_row. Modulo
  // 2**(2*Width), -n * 2**(Width+1) is 2**(Width+1) + ~n * 2**(Width+1). Bit 2k of n is digit k's sign, odd bits are
  // 0. So the odd bits of ~n are 1. These constants replace all sign extensions.

  logic [2*Width*Rows-1:0] rows;

  for (genvar k = 0; k < Digits; k++) begin : gen_row
    logic [Width:0] row;

    booth_row #(
      .Width(Width)
    ) u_row (
      .a_i,
      .one_i     (one[2*k]),
      .two_i     (two[2*k]),
      .negative_i(negative[2*k]),
      .row_o     (row)
    );

    if (ConstantRow) begin : gen_bare
      if (k == 0) begin : gen_first  // 2**(Width+1) fits above row 0
        assign rows[2*Width+:2*Width] = (2 * Width)'({1'b1, row});
      end else begin : gen_next
        assign rows[2*Width*(k+1)+:2*Width] = (2 * Width)'(row) << 2 * k;
      end
    end else begin : gen_full
      // n fits into the free bits below the last row. ~n fits above row 0, from bit Width + 1, but for ~n[2], which
      // goes to row 1: the constant 1 plus ~n[1:0] is 4 - n[0], and so takes three bits.
      if (k == 0) begin : gen_first
        assign rows[0+:2*Width] = (2 * Width)'({
          ~negative[2*Digits-1:3], ~negative[0], negative[0], negative[0], row
        });
      end else begin : gen_next
        localparam bit Second = k == 1;
        localparam bit Last = k == Digits - 1;
        assign rows[2*Width*k+:2*Width] = (2 * Width)'({
          {Second & ~negative[2], row}, {(2 * k) {Last}} & negative[2*k-1:0]
        });
      end
    end
  end

  if (ConstantRow) begin : gen_constant_row  // first in the tree: this row arrives first
    assign rows[0+:2*Width] = {~negative[Width-2:0], (Width + 1)'(negative)};
  end

  // Add

  logic [2*Width-1:0] sum, carry;

  carry_save_tree #(
    .Width(2 * Width),
    .Rows (Rows)
  ) u_tree (
    .rows_i (rows),
    .sum_o  (sum),
    .carry_o(carry)
  );


  adder #(
    .Width      (2 * Width),
    .Arith      (Arith),
    .GroupWidths(GroupWidths),
    .LookAhead  (LookAhead)
  ) u_adder (
    .a_i    (sum),
    .b_i    (carry),
    .carry_i(1'b0),
    .sum_o  (product_o),
    .carry_o()
  );

endmodule
