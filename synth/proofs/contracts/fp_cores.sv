// Contracts of the float cores: any result and any flags. Sufficient for proofs about control logic.
module fp_multiplier #(
  parameter int unsigned ExpWidth = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith = 0,
  parameter bit ConstantRow = 1'b0,
  parameter bit Pipelined = 1'b0
) (
  input  logic                        clk_i,
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  logic [2:0]                  rounding_mode_i,
  input  logic                        tininess_after_i,
  output logic [ExpWidth+FracWidth:0] result_o,
  output logic [4:0]                  flags_o
);
  (* anyseq *) logic [ExpWidth+FracWidth+5:0] any;
  assign {result_o, flags_o} = any;
endmodule

module fp_adder #(
  parameter int unsigned ExpWidth = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith = 0,
  parameter bit Pipelined = 1'b0
) (
  input  logic                        clk_i,
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  logic                        subtract_i,
  input  logic [2:0]                  rounding_mode_i,
  input  logic                        tininess_after_i,
  output logic [ExpWidth+FracWidth:0] result_o,
  output logic [4:0]                  flags_o
);
  (* anyseq *) logic [ExpWidth+FracWidth+5:0] any;
  assign {result_o, flags_o} = any;
endmodule

module fp_divider #(
  parameter int unsigned ExpWidth = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith = 0,
  parameter int unsigned QuotientBits = 0,
  parameter bit Pipelined = 1'b0
) (
  input  logic                        clk_i,
  input  logic                        valid_i,
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  logic [2:0]                  rounding_mode_i,
  input  logic                        tininess_after_i,
  output logic [ExpWidth+FracWidth:0] result_o,
  output logic [4:0]                  flags_o
);
  (* anyseq *) logic [ExpWidth+FracWidth+5:0] any;
  assign {result_o, flags_o} = any;
endmodule
