// A row that promises nothing: the query says what it does.
module srt_row #(
  parameter int unsigned Width = 25,
  parameter int unsigned DigitsWidth = 2,
  parameter int unsigned BesideWidth = 1,
  parameter int unsigned Arith = 0,
  parameter int unsigned Adder = 0,
  parameter bit          Pipelined = 1'b0
) (
  input  logic                   clk_i,
  input  logic                   enable_i,
  input  logic [Width-1:0]       sum_i,
  input  logic [Width-1:0]       carry_i,
  input  logic [Width-1:0]       divisor_i,
  input  logic [DigitsWidth-1:0] positives_i,
  input  logic [DigitsWidth-1:0] negatives_i,
  input  logic [BesideWidth-1:0] beside_i,
  output logic [Width-1:0]       sum_o,
  output logic [Width-1:0]       carry_o,
  output logic [Width-1:0]       divisor_o,
  output logic [DigitsWidth+1:0] positives_o,
  output logic [DigitsWidth+1:0] negatives_o,
  output logic [BesideWidth-1:0] beside_o
);
  (* keep *) logic [Width-1:0] free_sum_i, free_carry_i, free_divisor_i;
  (* keep *) logic [DigitsWidth-1:0] free_positives_i, free_negatives_i;
  (* anyseq, keep *) logic [Width-1:0] free_sum_o, free_carry_o;
  (* anyseq, keep *) logic [DigitsWidth+1:0] free_positives_o, free_negatives_o;
  assign {free_sum_i, free_carry_i, free_divisor_i} = {sum_i, carry_i, divisor_i};
  assign {free_positives_i, free_negatives_i} = {positives_i, negatives_i};
  assign {sum_o, carry_o, divisor_o} = {free_sum_o, free_carry_o, divisor_i};
  assign {positives_o, negatives_o} = {free_positives_o, free_negatives_o};
  assign beside_o = beside_i;
endmodule
