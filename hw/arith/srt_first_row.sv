// First row of the radix-4 SRT divider: chooses a digit of 1 .. 4. Combinational.
//
// The first residual is w = 2 x - digit * d, for a dividend x and a divisor d in [1, 2). dividend_doubled_i is 2 x.
// Residual and divisor have srt_row's formats. digit_o is the digit modulo 4.
module srt_first_row #(
  parameter int unsigned Width = 25
) (
  input  logic [Width-1:0] dividend_doubled_i,
  input  logic [Width-1:0] divisor_i,
  output logic [Width-1:0] sum_o,
  output logic [Width-1:0] carry_o,
  output logic [1:0]       digit_o
);

  // ---- Choose the digit (see srt_pkg) by the divisor's first four fraction bits

  localparam bit [8*16-1:0] First2 = srt_pkg::first_thresholds(2);
  localparam bit [8*16-1:0] First3 = srt_pkg::first_thresholds(3);
  localparam bit [8*16-1:0] First4 = srt_pkg::first_thresholds(4);

  logic [5:0] y;  // 2 x in eighths
  logic [6:0] sixteenth;  // bit index of the threshold's byte
  logic from_2, from_3, from_4;  // the digit is at least 2, 3, 4

  assign y = {1'b0, dividend_doubled_i[Width-1-:5]};
  assign sixteenth = {divisor_i[Width-3-:4], 3'b000};
  assign from_2 = y >= First2[sixteenth+:6];
  assign from_3 = y >= First3[sixteenth+:6];
  assign from_4 = y >= First4[sixteenth+:6];
  assign digit_o = {from_2 & ~from_4, ~from_2 | (from_3 & ~from_4)};

  // ---- Subtract two multiples, 0 or d, and 0, 2 d or 4 d: add complements, with each +1 in a free lowest bit

  logic [Width-1:0] upper, carry;

  assign upper = ({Width{digit_o[1]}} & (divisor_i << 1)) | ({Width{from_4}} & (divisor_i << 2));

  carry_save_adder #(
    .Width(Width)
  ) u_subtract (
    .a_i(dividend_doubled_i | Width'(1)),
    .b_i(~({Width{digit_o[0]}} & divisor_i)),
    .c_i(~upper),
    .sum_o,
    .carry_o(carry)
  );
  assign carry_o = carry | Width'(1);

endmodule
