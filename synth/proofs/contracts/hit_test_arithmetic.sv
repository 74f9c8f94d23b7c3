// The arithmetic of the pipelined unit, promising nothing: any word, and any one verdict. For what
// control does, that is enough.
module vec_scale #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = 0,
  parameter int unsigned Adder     = 0,
  parameter bit [2:0]    RoundingMode = 3'd0,
  parameter int unsigned Words     = 5,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic                   clk_i,
  input  logic [Words*Width-1:0] words_i,
  input  logic [Width-1:0]       factor_i,
  output logic [Words*Width-1:0] products_o
);
  (* anyseq *) logic [Words*Width-1:0] any;
  assign products_o = any;
endmodule

module fp_add3 #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = 0,
  parameter int unsigned Adder     = 0,
  parameter bit [2:0]    RoundingMode = 3'd0,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic             clk_i,
  input  logic [Width-1:0] x_i,
  input  logic [Width-1:0] y_i,
  input  logic [Width-1:0] z_i,
  output logic [Width-1:0] sum_o
);
  (* anyseq *) logic [Width-1:0] any;
  assign sum_o = any;
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

module fp_divider_stages #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = 0,
  parameter int unsigned Adder     = 0,
  parameter int unsigned QuotientBits = 0,
  parameter bit [31:0]   PipeRegs  = 32'd0
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
