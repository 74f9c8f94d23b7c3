// Carry-save adder, a row of full adders: a_i + b_i + c_i = sum_o + carry_o modulo 2**Width.
// carry_o is shifted left by one: bit 0 is 0, the top carry is dropped. Combinational; one full-adder delay.
module carry_save_adder #(
  parameter int unsigned Width = 48
) (
  input  logic [Width-1:0] a_i,
  input  logic [Width-1:0] b_i,
  input  logic [Width-1:0] c_i,
  output logic [Width-1:0] sum_o,
  output logic [Width-1:0] carry_o
);

  assign sum_o   = a_i ^ b_i ^ c_i;
  assign carry_o = ((a_i & b_i) | ((a_i ^ b_i) & c_i)) << 1;

endmodule
