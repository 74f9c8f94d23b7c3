// Claim: the two output words of exact_product add up to a b, or to -a b if `negate`, modulo 2**Width.
module exact_product_multiplies #(
  parameter int unsigned DigitWidth = 6,
  localparam int unsigned Width = 2 * DigitWidth + 3
) (
  input logic signed [DigitWidth-1:0] a,
  input logic signed [DigitWidth-1:0] b,
  input logic negate
);

  logic [Width-1:0] sum, carry, total;
  logic signed [Width-1:0] product;

  exact_product #(
    .DigitWidth(DigitWidth),
    .Width     (Width)
  ) dut (
    .a_i     (a),
    .b_i     (b),
    .negate_i(negate),
    .sum_o   (sum),
    .carry_o (carry)
  );

  assign total   = sum + carry;
  assign product = a * b;
  always_comb assert (total == $unsigned(negate ? -product : product));

endmodule
