// Cross product of two vectors, a x b, and the size of its terms.
// Latency: MultiplierLatency + AdderLatency (see hit_test_pkg), throughput one a clock.
//
//   product_k = a_i b_j - a_j b_i         each operation rounded, for (i, j, k) = (1, 2, 0) and so on
//   terms_k   = |a_i b_j| + |a_j b_i|     likewise: never less than |product_k|
// What cancels in a component shows in how much larger its terms are. Vectors are three binary32 words, x lowest.
// Takes every bit pattern; no flags.
module cross_product #(
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded
) (
  input  logic        clk_i,
  input  logic [95:0] a_i,
  input  logic [95:0] b_i,
  output logic [95:0] product_o,
  output logic [95:0] terms_o
);

  localparam logic [95:0] Magnitudes = {3{32'h7fff_ffff}};

  // Word k of each is the vector's word i, or j.
  logic [95:0] a_next, a_last, b_next, b_last;
  assign a_next = {a_i[31:0], a_i[95:32]};
  assign a_last = {a_i[63:0], a_i[95:64]};
  assign b_next = {b_i[31:0], b_i[95:32]};
  assign b_last = {b_i[63:0], b_i[95:64]};

  logic [95:0] left, right;  // a_i b_j, a_j b_i

  vec_mul #(
    .Words(6),
    .Arith(Arith),
    .Adder(Adder)
  ) u_terms (
    .clk_i,
    .a_i({a_last, a_next}),
    .b_i({b_next, b_last}),
    .product_o({right, left})
  );
  vec_add #(
    .Subtract(1'b1),
    .Arith(Arith),
    .Adder(Adder)
  ) u_difference (
    .clk_i,
    .a_i(left),
    .b_i(right),
    .sum_o(product_o)
  );
  vec_add #(
    .Arith(Arith),
    .Adder(Adder)
  ) u_size (
    .clk_i,
    .a_i(left & Magnitudes),
    .b_i(right & Magnitudes),
    .sum_o(terms_o)
  );

endmodule
