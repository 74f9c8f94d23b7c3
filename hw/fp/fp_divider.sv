// Floating-point divide: a_i / b_i.
//
// Combinational: fp_divider_stages without registers; see there.
module fp_divider #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = arith_pkg::Structural,
  parameter int unsigned Adder     = arith_pkg::AdderGraded,
  parameter int unsigned QuotientBits = 0
) (
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  logic [2:0]                  rounding_mode_i,
  input  logic                        tininess_after_i,
  output logic [ExpWidth+FracWidth:0] result_o,
  output fp_pkg::flags_t              flags_o
);

  fp_divider_stages #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .Arith(Arith),
    .Adder(Adder),
    .QuotientBits(QuotientBits)
  ) u_stages (
    .clk_i(1'b0),
    .valid_i(1'b1),
    .a_i,
    .b_i,
    .rounding_mode_i,
    .tininess_after_i,
    .result_o,
    .flags_o
  );

endmodule
