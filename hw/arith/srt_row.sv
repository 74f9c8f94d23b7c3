// One row of the radix-4 SRT divider: chooses a quotient digit, w' = 4 w - digit * d.
//
// Residuals are in carry-save form: w = sum + carry, modulo 4, two integer bits (the upper one is
// the sign) and Width - 2 fraction bits. d is in [1, 2) in the same places. |w| <= 2/3 d goes in
// and comes out. The digit is positive_o - negative_o, one of them 0.
//
// m_minus_1_i .. m_2_i: where the digits begin for this divisor, see srt_pkg.
//
// Combinational.
module srt_row #(
  parameter int unsigned Width = 25,
  parameter int unsigned Adder = arith_pkg::AdderGraded
) (
  input  logic [Width-1:0] sum_i,
  input  logic [Width-1:0] carry_i,
  input  logic [Width-1:0] divisor_i,
  input  logic [6:0]       m_minus_1_i,
  input  logic [6:0]       m_0_i,
  input  logic [6:0]       m_1_i,
  input  logic [6:0]       m_2_i,
  output logic [Width-1:0] sum_o,
  output logic [Width-1:0] carry_o,
  output logic [1:0]       positive_o,
  output logic [1:0]       negative_o
);

  localparam int unsigned EstimateWidth = 7;  // of 4 w: 4 integer bits with the sign, 3 more

  // ---- Estimate 4 w from the first bits of both words; with its sign bit inverted it compares as
  // an unsigned number

  logic [EstimateWidth-1:0] sum, estimate;
  logic unused_carry;

  adder #(
    .Width(EstimateWidth),
    .Adder(Adder)
  ) u_estimate (
    .a_i(sum_i[Width-1-:EstimateWidth]),
    .b_i(carry_i[Width-1-:EstimateWidth]),
    .carry_i(1'b0),
    .sum_o(sum),
    .carry_o(unused_carry)
  );
  assign estimate = {~sum[EstimateWidth-1], sum[EstimateWidth-2:0]};

  // ---- Choose the digit

  logic from_minus_1, from_0, from_1, from_2;  // the digit is that or more
  logic is_minus_1, is_1;

  assign from_minus_1 = estimate >= m_minus_1_i;
  assign from_0 = estimate >= m_0_i;
  assign from_1 = estimate >= m_1_i;
  assign from_2 = estimate >= m_2_i;
  assign is_minus_1 = from_minus_1 & ~from_0;
  assign is_1 = from_1 & ~from_2;
  assign positive_o = {from_2, is_1};
  assign negative_o = {~from_minus_1, is_minus_1};

  // ---- Subtract digit * d: a positive digit adds the complement, and the one that completes it
  // goes to the free last place of the carries

  logic [Width-1:0] addend, carry;

  assign addend = ({Width{from_2}} & ~(divisor_i << 1))
                | ({Width{is_1}} & ~divisor_i)
                | ({Width{is_minus_1}} & divisor_i)
                | ({Width{~from_minus_1}} & (divisor_i << 1));

  carry_save_adder #(
    .Width(Width)
  ) u_subtract (
    .a_i(sum_i << 2),
    .b_i(carry_i << 2),
    .c_i(addend),
    .sum_o,
    .carry_o(carry)
  );
  assign carry_o = carry | Width'(from_1);

endmodule
