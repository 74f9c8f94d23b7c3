// Dot product of two vectors of three: (x0 y0 + x1 y1) + x2 y2, rounded after each operation.
//
// The paper's accumulator starts from +0, which changes nothing but the sign of a zero.
// Throughput one a clock, latency hit_test_pkg::DotLatency; clocks without enable_i don't count.
// Takes every bit pattern; no flags.
module dot_product #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Adder     = arith_pkg::AdderGraded,
  parameter bit [2:0]    RoundingMode = 3'd0,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic               clk_i,
  input  logic               enable_i,
  input  logic [3*Width-1:0] x_i,
  input  logic [3*Width-1:0] y_i,
  output logic [Width-1:0]   result_o
);
  /* verilator no_inline_module */  // simulated by one piece of code, four times a lane

  // ---- Multiply

  logic [Width-1:0] product[3];

  for (genvar k = 0; k < 3; k++) begin : gen_product
    fp_pkg::flags_t unused_flags;

    fp_multiplier_stages #(
      .ExpWidth(ExpWidth),
      .FracWidth(FracWidth),
      .Adder(Adder),
      .Cuts(hit_test_pkg::MultiplierCuts)
    ) u_multiplier (
      .clk_i,
      .enable_i,
      .a_i(x_i[Width*k +: Width]),
      .b_i(y_i[Width*k +: Width]),
      .rounding_mode_i(RoundingMode),
      .tininess_after_i(1'b0),
      .result_o(product[k]),
      .flags_o(unused_flags)
    );
  end

  // ---- Add, the third product waiting for the sum of the others

  logic [Width-1:0] sum, product_2;
  fp_pkg::flags_t unused_flags_1, unused_flags_2;

  fp_adder_stages #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .Adder(Adder),
    .Cuts(hit_test_pkg::AdderCuts)
  ) u_first_sum (
    .clk_i,
    .enable_i,
    .a_i(product[0]),
    .b_i(product[1]),
    .subtract_i(1'b0),
    .rounding_mode_i(RoundingMode),
    .tininess_after_i(1'b0),
    .result_o(sum),
    .flags_o(unused_flags_1)
  );
  delay_line #(
    .Width(Width),
    .Depth(hit_test_pkg::AdderLatency)
  ) u_product_2 (
    .clk_i,
    .enable_i,
    .data_i(product[2]),
    .data_o(product_2)
  );
  fp_adder_stages #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .Adder(Adder),
    .Cuts(hit_test_pkg::AdderCuts)
  ) u_second_sum (
    .clk_i,
    .enable_i,
    .a_i(sum),
    .b_i(product_2),
    .subtract_i(1'b0),
    .rounding_mode_i(RoundingMode),
    .tininess_after_i(1'b0),
    .result_o,
    .flags_o(unused_flags_2)
  );

endmodule
