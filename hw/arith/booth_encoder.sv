// Radix-4 Booth recoding of an unsigned number, all digits at once.
//
// b_i is the sum of digit[k] * 4**k, with digit[k] = -2 b[2k+1] + b[2k] + b[2k-1] in -2 .. 2. Bits of b below 0 and
// above its top count as 0, so the last digit is never negative. There are Width / 2 + 1 digits, 13 for 24 bits. Bit 2k
// of each output describes digit k; odd bits are 0. one_o: the digit is 1 or -1. two_o: it is 2 or -2. negative_o:
// b[2k+1], which is 1 for a negative digit, and also for digit 0 if its three bits of b are 111. Combinational.
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
