// Gate-level adder in which one gate may be broken. `make page` uses this file instead of hw/fp/fp_adder.sv.
//
// fp_adder_gates is Yosys's netlist of fp_adder in binary32 with single faults (sim/mutate/netlist.py). The page sets
// `mutant` to 0 for the fault-free adder, or to k for fault k in the netlist's list.
module fp_adder #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = arith_pkg::Graded,
  parameter bit          Pipelined = 1'b0
) (
  input  logic                        clk_i,
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  logic                        subtract_i,
  input  logic [2:0]                  rounding_mode_i,
  input  logic                        tininess_after_i,
  output logic [ExpWidth+FracWidth:0] result_o,
  output fp_pkg::flags_t              flags_o
);

  logic [15:0] mutant  /*verilator public_flat_rw*/;

  fp_adder_gates u_gates (
    .clk_i,
    .a_i,
    .b_i,
    .subtract_i,
    .rounding_mode_i,
    .tininess_after_i,
    .mutant,
    .result_o,
    .flags_o
  );

endmodule
