// One row of the radix-4 SRT divider: chooses a quotient digit. Combinational.
//
// The next residual is w' = 4 w - digit * d. Residuals are in carry-save form: w = sum + carry, modulo 4, two integer
// bits (the upper one is the sign) and Width - 2 fraction bits. The divisor d is in [1, 2) in the same format. |w| must
// be at most 2/3 d; |w'| is then, too. The digit is positive_o - negative_o, one of which is 0.
module srt_row #(
  parameter int unsigned Width = 25,
  parameter int unsigned Arith = arith_pkg::Graded
) (
  input  logic [Width-1:0] sum_i,
  input  logic [Width-1:0] carry_i,
  input  logic [Width-1:0] divisor_i,
  output logic [Width-1:0] sum_o,
  output logic [Width-1:0] carry_o,
  output logic [1:0]       positive_o,
  output logic [1:0]       negative_o
);

  localparam int unsigned EstimateWidth = 7;  // the estimate of 4 w: 4 integer, 3 fraction bits

  // ---- Estimate 4 w from the first bits of sum_i and carry_i

  logic [EstimateWidth-1:0] estimate;

  adder #(
    .Width(EstimateWidth),
    .Arith(Arith)
  ) u_estimate (
    .a_i(sum_i[Width-1-:EstimateWidth]),
    .b_i(carry_i[Width-1-:EstimateWidth]),
    .carry_i(1'b0),
    .sum_o(estimate),
    .carry_o()
  );

  // ---- Choose the digit (see srt_pkg) by the divisor's first three fraction bits. With its sign bit inverted, the
  // estimate compares as an unsigned number. `multiple` is -digit * d, without the +1 of two's complement

  localparam bit [8*8-1:0] MMinus1 = srt_pkg::thresholds(-1);
  localparam bit [8*8-1:0] M0 = srt_pkg::thresholds(0);
  localparam bit [8*8-1:0] M1 = srt_pkg::thresholds(1);
  localparam bit [8*8-1:0] M2 = srt_pkg::thresholds(2);

  logic [EstimateWidth-1:0] y;
  logic [5:0] eighth;  // bit index of the threshold's byte
  logic [3:0] from;  // [n]: the digit is at least n - 1
  logic [Width-1:0] multiple;

  assign y = estimate ^ {1'b1, {(EstimateWidth - 1) {1'b0}}};
  assign eighth = {divisor_i[Width-3-:3], 3'b000};

  assign from[0] = y >= MMinus1[eighth+:EstimateWidth];
  assign from[1] = y >= M0[eighth+:EstimateWidth];
  assign from[2] = y >= M1[eighth+:EstimateWidth];
  assign from[3] = y >= M2[eighth+:EstimateWidth];
  // At most one of the four bits of positive_o and negative_o is 1.
  assign positive_o = {from[3], from[2] & ~from[3]};
  assign negative_o = {~from[0], from[0] & ~from[1]};
  assign multiple = {Width{from[2]}}
                  ^ (({Width{positive_o[0] | negative_o[0]}} & divisor_i)
                   | ({Width{positive_o[1] | negative_o[1]}} & (divisor_i << 1)));

  // ---- Subtract: the +1 of two's complement goes into the free lowest bit of the carries

  logic [Width-1:0] carry;

  carry_save_adder #(
    .Width(Width)
  ) u_subtract (
    .a_i(sum_i << 2),
    .b_i(carry_i << 2),
    .c_i(multiple),
    .sum_o,
    .carry_o(carry)
  );
  assign carry_o = carry | Width'(from[2]);

endmodule
