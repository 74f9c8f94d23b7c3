// Carry-save adder, a row of full adders: a_i + b_i + c_i = sum_o + carry_o modulo 2**Width.
// carry_o has its place value already (its bit 0 is 0; the top carry is dropped).
// Combinational; one full-adder delay.
module carry_save_adder #(
  parameter int unsigned Width = 48
) (
  input  logic [Width-1:0] a_i,
  input  logic [Width-1:0] b_i,
  input  logic [Width-1:0] c_i,
  output logic [Width-1:0] sum_o,
  output logic [Width-1:0] carry_o
);

  // full_adder, word-wide: one instance a bit simulates seven times slower
  logic [Width-1:0] half_sum;
  assign half_sum = a_i ^ b_i;
  assign sum_o    = half_sum ^ c_i;
  assign carry_o  = ((a_i & b_i) | (half_sum & c_i)) << 1;

endmodule
