// Contract of a divider of significands: quotient and remainder are arbitrary here, and are constrained in the query.
module srt_divider #(
  parameter int unsigned Width = 24,
  parameter int unsigned Rows  = 12,
  parameter int unsigned SideWidth = 1,
  parameter int unsigned Arith = 0,
  parameter bit          Pipelined = 1'b0
) (
  input  logic                clk_i,
  input  logic                valid_i,
  input  logic [Width-1:0]    dividend_i,
  input  logic [Width-1:0]    divisor_i,
  input  logic [SideWidth-1:0] side_i,
  output logic [2*Rows+1:0]   quotient_o,
  output logic                remainder_o,
  output logic [SideWidth-1:0] side_o,
  output logic                valid_o
);
  (* keep *) logic [Width-1:0] free_dividend, free_divisor;
  (* anyseq, keep *) logic [2*Rows+1:0] free_quotient;
  (* anyseq, keep *) logic free_left;
  assign free_dividend = dividend_i;
  assign free_divisor = divisor_i;
  assign quotient_o = free_quotient;
  assign remainder_o = free_left;
  assign side_o = side_i;
  assign valid_o = valid_i;
endmodule
