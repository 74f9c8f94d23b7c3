// Claim: exact_slice returns digit `number` of significand * 2**shift, in base 2**DigitWidth.
module exact_slice_cuts #(
  parameter int unsigned SignificandWidth = 24,
  parameter int unsigned MaxShift = 405,
  parameter int unsigned DigitWidth = 48,
  localparam int unsigned Wide = DigitWidth * 65
) (
  input logic [SignificandWidth-1:0] significand,
  input logic [$clog2(MaxShift+1)-1:0] shift,
  input logic [5:0] number
);

  logic [DigitWidth-1:0] digit;
  logic [Wide-1:0] shifted;

  exact_slice #(
    .SignificandWidth(SignificandWidth),
    .MaxShift        (MaxShift),
    .DigitWidth      (DigitWidth)
  ) dut (
    .significand_i(significand),
    .shift_i      (shift),
    .digit_i      (number),
    .digit_o      (digit)
  );

  assign shifted = Wide'(significand) << shift;
  for (genvar k = 0; k < 64; k++) begin : gen_digit
    always_comb assert (number != k || digit == shifted[DigitWidth*k+:DigitWidth]);
  end
  always_comb begin
    assume (shift <= MaxShift);
    cover (digit != '0 && number == 6'd8);
  end

endmodule
