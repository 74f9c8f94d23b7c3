// Unsigned multiplier: product_o = a_i * b_i.
//
// Radix-4 Booth recoding of b_i (13 partial products for 24 bits), constants in place of sign
// extension (a 14th row), a carry-save tree (12 adders in 6 levels), a carry-propagate adder of
// 2 * Width bits: the paper's multiplier (section 3.4), for any Width from 2.
//
// Adder, GroupWidths: the last adder, see there. Combinational.
module booth_multiplier #(
  parameter int unsigned Width = 24,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  parameter bit [8*arith_pkg::MaxGroups-1:0] GroupWidths = '0
) (
  input  logic [Width-1:0]   a_i,
  input  logic [Width-1:0]   b_i,
  output logic [2*Width-1:0] product_o
);

  localparam int unsigned Digits = Width / 2 + 1;
  localparam int unsigned Rows = Digits + 1;

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
  // What they lack is, with n the word `negative`, n - n * 2**(Width+1). Modulo 2**(2*Width)
  //   -n = ~n + 1,
  // so one more row holds n and, from bit Width + 1 on, ~n (whose odd bits are the constants that
  // stand for all sign extensions); the 1 finds room above row 0.

  logic [2*Width*Rows-1:0] rows  /*verilator split_var*/;  // simulated as Rows words

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

    if (k == 0) begin : gen_first
      assign rows[0 +: 2*Width] = (2 * Width)'({1'b1, row});
    end else begin : gen_next
      assign rows[2*Width*k +: 2*Width] = (2 * Width)'(row) << 2 * k;
    end
  end

  assign rows[2*Width*Digits +: 2*Width] =
      {~negative[Width-2:0], (Width + 1)'(negative)};

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

  logic unused_carry;  // of weight 2**(2 * Width): the constants are right modulo that

  adder #(
    .Width      (2 * Width),
    .Adder      (Adder),
    .GroupWidths(GroupWidths)
  ) u_adder (
    .a_i    (sum),
    .b_i    (carry),
    .carry_i(1'b0),
    .sum_o  (product_o),
    .carry_o(unused_carry)
  );

endmodule
