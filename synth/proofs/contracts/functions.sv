// Contracts of the float cores as uninterpreted functions: only "equal operands give equal results" is known. For
// proofs about a unit's data flow: which words enter which cores, and where the results go.
//
// induction.py constrains each X_result to be function X of X_operands. Cores are combinational or fully pipelined, as
// in the units. The pipelined divider gives an arbitrary result for operands without valid_i.
module fp_adder #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = 0,
  parameter bit          Pipelined  = 1'b0
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
  localparam int unsigned Width = 2 * (1 + ExpWidth + FracWidth) + 5;
  (* keep *) logic [Width-1:0] add_operands;
  (* anyseq, keep *) logic [ExpWidth+FracWidth+5:0] add_result;

  delay_line #(
    .Width(Width),
    .Depth(!Pipelined ? 0 : hit_test_pkg::AdderLatency)
  ) u_operands (
    .clk_i,
    .enable_i(1'b1),
    .data_i({a_i, b_i, subtract_i, rounding_mode_i, tininess_after_i}),
    .data_o(add_operands)
  );
  assign {result_o, flags_o} = add_result;
endmodule

module fp_multiplier #(
  parameter int unsigned ExpWidth    = 8,
  parameter int unsigned FracWidth   = 23,
  parameter int unsigned Arith       = 0,
  parameter bit          ConstantRow = 1'b0,
  parameter bit          Pipelined    = 1'b0
) (
  input  logic                        clk_i,
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  logic [2:0]                  rounding_mode_i,
  input  logic                        tininess_after_i,
  output logic [ExpWidth+FracWidth:0] result_o,
  output logic [4:0]                  flags_o
);
  localparam int unsigned Width = 2 * (1 + ExpWidth + FracWidth) + 4;
  (* keep *) logic [Width-1:0] multiply_operands;
  (* anyseq, keep *) logic [ExpWidth+FracWidth+5:0] multiply_result;

  delay_line #(
    .Width(Width),
    .Depth(!Pipelined ? 0 : hit_test_pkg::MultiplierLatency)
  ) u_operands (
    .clk_i,
    .enable_i(1'b1),
    .data_i({a_i, b_i, rounding_mode_i, tininess_after_i}),
    .data_o(multiply_operands)
  );
  assign {result_o, flags_o} = multiply_result;
endmodule

module fp_divider #(
  parameter int unsigned ExpWidth     = 8,
  parameter int unsigned FracWidth    = 23,
  parameter int unsigned Arith        = 0,
  parameter int unsigned QuotientBits = 0,
  parameter bit          Pipelined     = 1'b0
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
  localparam int unsigned Width = 2 * (1 + ExpWidth + FracWidth) + 4;
  logic valid;
  (* keep *) logic [Width-1:0] divide_operands;
  (* anyseq, keep *) logic [ExpWidth+FracWidth+5:0] divide_result;
  (* anyseq *) logic [ExpWidth+FracWidth+5:0] any;

  delay_line #(
    .Width(1 + Width),
    .Depth(!Pipelined ? 0 : hit_test_pkg::divide_latency(FracWidth))
  ) u_operands (
    .clk_i,
    .enable_i(1'b1),
    .data_i({valid_i, a_i, b_i, rounding_mode_i, tininess_after_i}),
    .data_o({valid, divide_operands})
  );
  assign {result_o, flags_o} = valid ? divide_result : any;
endmodule
