// Contract of a carry-save adder, proven in step 4 of the multiplier's proof (carry_save_preserves.sv): the outputs are
// any two words whose sum, modulo 2**Width, is that of the three inputs.
module carry_save_adder #(
  parameter int unsigned Width = 48
) (
  input  logic [Width-1:0] a_i,
  input  logic [Width-1:0] b_i,
  input  logic [Width-1:0] c_i,
  output logic [Width-1:0] sum_o,
  output logic [Width-1:0] carry_o
);

  (* anyseq *) logic [Width-1:0] any;
  assign sum_o   = any;
  assign carry_o = a_i + b_i + c_i - any;

endmodule
