// The cross product of two vectors, a x b, and how large its terms are:
//   product_k = a_i b_j - a_j b_i         each operation rounded, for (i, j, k) = (1, 2, 0) and so on
//   terms_k   = |a_i b_j| + |a_j b_i|     likewise: never less than |product_k|
// What cancels in a component shows in how much larger its terms are.
//
// Vectors are three words, x lowest. Throughput one a clock, latency MultiplierLatency + AdderLatency
// (see hit_test_pkg). Takes every bit pattern; no flags.
module cross_product #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = arith_pkg::Structural,
  parameter int unsigned Adder     = arith_pkg::AdderGraded,
  parameter bit [2:0]    RoundingMode = 3'd0,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic               clk_i,
  input  logic [3*Width-1:0] a_i,
  input  logic [3*Width-1:0] b_i,
  output logic [3*Width-1:0] product_o,
  output logic [3*Width-1:0] terms_o
);

  for (genvar k = 0; k < 3; k++) begin : gen_component
    localparam int unsigned I = (k + 1) % 3;
    localparam int unsigned J = (k + 2) % 3;
    logic [Width-1:0] left, right;  // a_i b_j, a_j b_i

    for (genvar n = 0; n < 2; n++) begin : gen_term
      logic [Width-1:0] term;
      fp_pkg::flags_t unused_flags;

      fp_multiplier_stages #(
        .ExpWidth(ExpWidth),
        .FracWidth(FracWidth),
        .Arith(Arith),
        .Adder(Adder),
        .Cuts(hit_test_pkg::MultiplierCuts)
      ) u_multiplier (
        .clk_i,
        .a_i(a_i[Width*(n == 0 ? I : J) +: Width]),
        .b_i(b_i[Width*(n == 0 ? J : I) +: Width]),
        .rounding_mode_i(RoundingMode),
        .tininess_after_i(1'b0),
        .result_o(term),
        .flags_o(unused_flags)
      );
    end
    assign left  = gen_term[0].term;
    assign right = gen_term[1].term;

    fp_pkg::flags_t unused_flags_product, unused_flags_terms;

    fp_adder_stages #(
      .ExpWidth(ExpWidth),
      .FracWidth(FracWidth),
      .Arith(Arith),
      .Adder(Adder),
      .Cuts(hit_test_pkg::AdderCuts)
    ) u_product (
      .clk_i,
      .a_i(left),
      .b_i(right),
      .subtract_i(1'b1),
      .rounding_mode_i(RoundingMode),
      .tininess_after_i(1'b0),
      .result_o(product_o[Width*k +: Width]),
      .flags_o(unused_flags_product)
    );
    fp_adder_stages #(
      .ExpWidth(ExpWidth),
      .FracWidth(FracWidth),
      .Arith(Arith),
      .Adder(Adder),
      .Cuts(hit_test_pkg::AdderCuts)
    ) u_terms (
      .clk_i,
      .a_i({1'b0, left[Width-2:0]}),
      .b_i({1'b0, right[Width-2:0]}),
      .subtract_i(1'b0),
      .rounding_mode_i(RoundingMode),
      .tininess_after_i(1'b0),
      .result_o(terms_o[Width*k +: Width]),
      .flags_o(unused_flags_terms)
    );
  end

endmodule
