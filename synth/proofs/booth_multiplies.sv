// Claim: product_o = a_i * b_i for all operands. For small widths, the whole multiplier is proven at once.
module booth_multiplies #(
  parameter int unsigned Width = 8
) (
  input  logic [Width-1:0]   a,
  input  logic [Width-1:0]   b,
  output logic [2*Width-1:0] product
);

  booth_multiplier #(
    .Width(Width)
  ) dut (
    .a_i      (a),
    .b_i      (b),
    .product_o(product)
  );

  always_comb assert (product == (2 * Width)'(a) * (2 * Width)'(b));

endmodule
