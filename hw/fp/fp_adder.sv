// Floating-point add and subtract: a_i + b_i, or a_i - b_i with subtract_i.
//
// Combinational: fp_adder_stages without registers; see there.
module fp_adder #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = arith_pkg::Structural,
  parameter int unsigned Adder     = arith_pkg::AdderGraded
) (
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  logic                        subtract_i,
  input  logic [2:0]                  rounding_mode_i,
  input  logic                        tininess_after_i,
  output logic [ExpWidth+FracWidth:0] result_o,
  output fp_pkg::flags_t              flags_o
);

  fp_adder_stages #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .Arith(Arith),
    .Adder(Adder)
  ) u_stages (
    .clk_i(1'b0),
    .a_i,
    .b_i,
    .subtract_i,
    .rounding_mode_i,
    .tininess_after_i,
    .result_o,
    .flags_o
  );

endmodule
