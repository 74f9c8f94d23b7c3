// Contract of a divider's first row: the outputs are arbitrary here, and are constrained in the query.
module srt_first_row #(
  parameter int unsigned Width = 25
) (
  input  logic [Width-1:0] dividend_doubled_i,
  input  logic [Width-1:0] divisor_i,
  output logic [Width-1:0] sum_o,
  output logic [Width-1:0] carry_o,
  output logic [1:0]       digit_o
);
  (* keep *) logic [Width-1:0] free_dividend_doubled_i, free_divisor_i;
  (* anyseq, keep *) logic [Width-1:0] free_sum_o, free_carry_o;
  (* anyseq, keep *) logic [1:0] free_digit_o;
  assign {free_dividend_doubled_i, free_divisor_i} = {dividend_doubled_i, divisor_i};
  assign {sum_o, carry_o, digit_o} = {free_sum_o, free_carry_o, free_digit_o};
endmodule
