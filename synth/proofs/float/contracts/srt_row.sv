// Contract of a divider's row: the outputs are arbitrary here, and are constrained in the query.
module srt_row #(
  parameter int unsigned Width = 25,
  parameter int unsigned Arith = 0
) (
  input  logic [Width-1:0] sum_i,
  input  logic [Width-1:0] carry_i,
  input  logic [Width-1:0] divisor_i,
  output logic [Width-1:0] sum_o,
  output logic [Width-1:0] carry_o,
  output logic [1:0]       positive_o,
  output logic [1:0]       negative_o
);
  (* keep *) logic [Width-1:0] free_sum_i, free_carry_i, free_divisor_i;
  (* anyseq, keep *) logic [Width-1:0] free_sum_o, free_carry_o;
  (* anyseq, keep *) logic [1:0] free_positive_o, free_negative_o;
  assign {free_sum_i, free_carry_i, free_divisor_i} = {sum_i, carry_i, divisor_i};
  assign {sum_o, carry_o} = {free_sum_o, free_carry_o};
  assign {positive_o, negative_o} = {free_positive_o, free_negative_o};
endmodule
