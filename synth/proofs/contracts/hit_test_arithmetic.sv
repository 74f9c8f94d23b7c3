// Contracts of the pipelined unit's arithmetic: arbitrary words, and exactly one of miss, hit and doubt. Sufficient for
// proofs about control logic.
module hit_dots #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = 0,
  parameter bit [2:0]    RoundingMode = 3'd0,
  parameter int unsigned Clocks    = 1,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic               clk_i,
  input  logic               step_i,
  input  logic [3*Width-1:0] normal_i,
  input  logic [9*Width-1:0] edges_i,
  input  logic [Width-1:0]   d_i,
  input  logic [3*Width-1:0] direction_i,
  output logic [Width-1:0]   v_o,
  output logic [3*Width-1:0] u_o,
  output logic [3*Width-1:0] dividends_o
);
  (* anyseq *) logic [7*Width-1:0] any;
  assign {v_o, u_o, dividends_o} = any;
endmodule

module hit_decision #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic [Width-1:0]                     d_i,
  input  logic [ExpWidth-1:0]                  normal_exponent_i,
  input  logic [Width-1:0]                     v_i,
  input  logic [3*Width-1:0]                   u_i,
  input  logic [3*Width-1:0]                   bounds_i,
  output logic                                 miss_o,
  output logic                                 hit_o,
  output logic                                 doubt_o,
  output logic [hit_test_pkg::TErrorWidth-1:0] t_error_o
);
  (* anyseq *) logic sure, is_inside;
  (* anyseq *) logic [hit_test_pkg::TErrorWidth-1:0] any;
  assign miss_o = sure && !is_inside;
  assign hit_o = sure && is_inside;
  assign doubt_o = !sure;
  assign t_error_o = any;
endmodule

module fp_divider #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = 0,
  parameter int unsigned QuotientBits = 0,
  parameter bit          Pipelined  = 1'b0
) (
  input  logic                        clk_i,
  input  logic                        valid_i,
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  logic [2:0]                  rounding_mode_i,
  input  logic                        tininess_after_i,
  output logic [ExpWidth+FracWidth:0] result_o,
  output fp_pkg::flags_t              flags_o
);
  (* anyseq *) logic [ExpWidth+FracWidth+5:0] any;
  assign {result_o, flags_o} = any;
endmodule
