// Radix-4 Booth recoding of an unsigned number, all digits at once.
//
// b_i = sum over k of digit[k] * 4**k, digit[k] = -2 b[2k+1] + b[2k] + b[2k-1] in -2 .. 2. Bits above the top of b_i
// count as 0, so the last digit is never negative. Bit 2k of one_o: digit k is 1 or -1; of two_o: it is 2 or -2; of
// negative_o: it is subtracted (also the 0 of bits 111). Bits 2k + 1 are 0. Digits: Width / 2 + 1, 13 for 24 bits.
// Combinational.
// Source: O. L. MacSorley, "High-speed arithmetic in binary computers", Proc. IRE 49, 1961.
module booth_encoder #(
  parameter  int unsigned Width  = 24,
  localparam int unsigned Digits = Width / 2 + 1
) (
  input  logic [Width-1:0]    b_i,
  output logic [2*Digits-1:0] one_o,
  output logic [2*Digits-1:0] two_o,
  output logic [2*Digits-1:0] negative_o
);

  localparam logic [2*Digits-1:0] EvenBits = {Digits{2'b01}};

  logic [2*Digits-1:0] low, middle, high;  // bit 2k: b[2k-1], b[2k], b[2k+1]

  assign middle = (2 * Digits)'(b_i);
  assign low    = middle << 1;
  assign high   = middle >> 1;

  assign one_o      = EvenBits & (middle ^ low);
  assign two_o      = EvenBits & (high ^ middle) & ~(middle ^ low);
  assign negative_o = EvenBits & high;

endmodule
