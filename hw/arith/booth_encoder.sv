// Radix-4 Booth recoding of an unsigned number, all digits at once.
//
// b_i = sum over k of digit[k] * 4**k, digit[k] = -2 b[2k+1] + b[2k] + b[2k-1] in -2 .. 2. Bits above the top of b_i
// count as 0, so the last digit is never negative. For each digit bit 2k of three words says that it is 1 or -1, that
// it is 2 or -2, that it is to be subtracted (also where bits 111 make 0); bits 2k + 1 are 0. Digits: Width / 2 + 1, 13
// for 24 bits. Combinational.
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

  logic [2*Digits-1:0] low, middle, high;  // with b[2k-1], b[2k], b[2k+1] at bit 2k

  assign middle = (2 * Digits)'(b_i);
  assign low    = middle << 1;
  assign high   = middle >> 1;

  assign one_o      = EvenBits & (middle ^ low);
  assign two_o      = EvenBits & (high ^ middle) & ~(middle ^ low);
  assign negative_o = EvenBits & high;

endmodule
