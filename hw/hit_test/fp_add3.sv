// Adds three words: (x + y) + z, rounded after each addition.
// Latency: 2 * hit_test_pkg::AdderLatency, throughput one a clock. Takes every bit pattern; no flags.
module fp_add3 #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = arith_pkg::Structural,
  parameter int unsigned Adder     = arith_pkg::AdderGraded,
  parameter bit [2:0]    RoundingMode = 3'd0,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic             clk_i,
  input  logic [Width-1:0] x_i,
  input  logic [Width-1:0] y_i,
  input  logic [Width-1:0] z_i,
  output logic [Width-1:0] sum_o
);

  logic [Width-1:0] first_sum, z;
  fp_pkg::flags_t unused_flags_1, unused_flags_2;

  fp_adder_stages #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .Arith(Arith),
    .Adder(Adder),
    .PipeRegs(hit_test_pkg::AdderPipeRegs)
  ) u_first (
    .clk_i,
    .a_i(x_i),
    .b_i(y_i),
    .subtract_i(1'b0),
    .rounding_mode_i(RoundingMode),
    .tininess_after_i(1'b0),
    .result_o(first_sum),
    .flags_o(unused_flags_1)
  );
  delay_line #(
    .Width(Width),
    .Depth(hit_test_pkg::AdderLatency)
  ) u_z (
    .clk_i,
    .enable_i(1'b1),
    .data_i(z_i),
    .data_o(z)
  );
  fp_adder_stages #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .Arith(Arith),
    .Adder(Adder),
    .PipeRegs(hit_test_pkg::AdderPipeRegs)
  ) u_second (
    .clk_i,
    .a_i(first_sum),
    .b_i(z),
    .subtract_i(1'b0),
    .rounding_mode_i(RoundingMode),
    .tininess_after_i(1'b0),
    .result_o(sum_o),
    .flags_o(unused_flags_2)
  );

endmodule
