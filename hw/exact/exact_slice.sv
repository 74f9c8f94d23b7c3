// A digit of a shifted significand: significand_i * 2**shift_i is cut into digits of DigitWidth bits; digit_o is the
// digit with index digit_i, or 0 beyond the last. shift_i is at most MaxShift. Combinational.
module exact_slice
  import exact_pkg::*;
#(
  parameter int unsigned SignificandWidth = 24,
  parameter int unsigned MaxShift = 405,
  parameter int unsigned DigitWidth = 48,
  localparam int unsigned ShiftWidth = $clog2(MaxShift + 1)
) (
  input  logic [SignificandWidth-1:0] significand_i,
  input  logic [ShiftWidth-1:0]       shift_i,
  input  logic [CountWidth-1:0]       digit_i,
  output logic [DigitWidth-1:0]       digit_o
);

  if (SignificandWidth > DigitWidth) begin : gen_check
    $error("exact_slice: expected a DigitWidth of SignificandWidth or more");
  end

  localparam int unsigned RestWidth = $clog2(DigitWidth);

  // ---- shift = DigitWidth quotient + rest

  logic [CountWidth-1:0] quotient;
  logic [RestWidth-1:0] rest;

  always_comb begin
    quotient = '0;
    rest     = RestWidth'(shift_i);
    for (int unsigned k = 1; DigitWidth * k <= MaxShift; k++) begin
      if (32'(shift_i) >= DigitWidth * k) begin
        quotient = CountWidth'(k);
        rest     = RestWidth'(32'(shift_i) - DigitWidth * k);
      end
    end
  end

  // ---- The significand lies in digits quotient and quotient + 1

  logic [2*DigitWidth-1:0] shifted;

  assign shifted = (2 * DigitWidth)'(significand_i) << rest;
  assign digit_o = (digit_i == quotient) ? shifted[DigitWidth-1:0]
                 : (digit_i == quotient + 1'b1) ? shifted[2*DigitWidth-1:DigitWidth] : '0;

endmodule
