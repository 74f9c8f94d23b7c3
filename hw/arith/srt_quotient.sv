// What ends a radix-4 SRT division: the quotient of the digits, and whether anything is left.
//
// sum_i, carry_i: the last residual, as srt_row gives it. positives_i, negatives_i: the digits, two bits each, the first
// one at the top. quotient_o: positive less negative digits, less a unit of the last place where the residual is
// negative, so that it is cut off and not rounded.
//
// Pipelined: registers behind the remainder and the quotient. Latency: 2 clocks, a quotient a clock; else combinational.
// Registers load only what is valid: valid_o is valid_i, as much later, and side_i goes along. Nothing is reset.
module srt_quotient #(
  parameter int unsigned Width = 25,  // of the residual
  parameter int unsigned Digits = 13,
  parameter int unsigned SideWidth = 1,
  parameter int unsigned Arith = arith_pkg::Graded,
  parameter bit          Pipelined = 1'b0
) (
  input  logic                 clk_i,
  input  logic                 valid_i,
  input  logic [Width-1:0]     sum_i,
  input  logic [Width-1:0]     carry_i,
  input  logic [2*Digits-1:0]  positives_i,
  input  logic [2*Digits-1:0]  negatives_i,
  input  logic [SideWidth-1:0] side_i,
  output logic [2*Digits-1:0]  quotient_o,
  output logic                 remainder_o,
  output logic [SideWidth-1:0] side_o,
  output logic                 valid_o
);

  // ---- Remainder: a negative one takes a unit off the quotient. (Then it is d - |w|, never zero.)

  logic [Width-1:0] remainder;

  adder #(
    .Width(Width),
    .Arith(Arith)
  ) u_remainder (
    .a_i(sum_i),
    .b_i(carry_i),
    .carry_i(1'b0),
    .sum_o(remainder),
    .carry_o()
  );

  logic [2*Digits-1:0] plus, minus;
  logic [SideWidth-1:0] remainder_side;
  logic remainder_negative, remainder_left, remainder_valid;

  delay_line #(
    .Width(1),
    .Depth(32'(Pipelined))
  ) u_valid_remainder (
    .clk_i,
    .enable_i(1'b1),
    .data_i(valid_i),
    .data_o(remainder_valid)
  );
  delay_line #(
    .Width(4 * Digits + SideWidth + 2),
    .Depth(32'(Pipelined))
  ) u_cut_remainder (
    .clk_i,
    .enable_i(valid_i),
    .data_i({positives_i, negatives_i, side_i, remainder[Width-1], |remainder}),
    .data_o({plus, minus, remainder_side, remainder_negative, remainder_left})
  );

  // ---- Quotient: positive less negative digits, less that unit

  logic [2*Digits-1:0] quotient;

  adder #(
    .Width(2 * Digits),
    .Arith(Arith)
  ) u_quotient (
    .a_i(plus),
    .b_i(~minus),
    .carry_i(~remainder_negative),
    .sum_o(quotient),
    .carry_o()
  );

  delay_line #(
    .Width(1),
    .Depth(32'(Pipelined))
  ) u_valid_quotient (
    .clk_i,
    .enable_i(1'b1),
    .data_i(remainder_valid),
    .data_o(valid_o)
  );
  delay_line #(
    .Width(2 * Digits + SideWidth + 1),
    .Depth(32'(Pipelined))
  ) u_cut_quotient (
    .clk_i,
    .enable_i(remainder_valid),
    .data_i({quotient, remainder_left, remainder_side}),
    .data_o({quotient_o, remainder_o, side_o})
  );

endmodule
