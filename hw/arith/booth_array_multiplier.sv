// Unsigned multiplier: product_o = a_i * b_i. An array in place of booth_multiplier's tree: the rows are
// added one after the other, which takes longer in hardware and is what a simulation does fastest.
//
// Radix-8 Booth recoding of b_i: b_i = sum over k of digit[k] * 8**k, digit[k] = -4 b[3k+2] + 2 b[3k+1]
// + b[3k] + b[3k-1] in -4 .. 4 (9 digits for 24 bits). Each digit selects its multiple of a_i from a
// table of them, a carry-save adder takes each row in, and the tool's `+` adds sum and carry in the end.
//
// For the simulator: steps on whole words, of 64 bits up to Width = 32, so that neither shifts nor
// carries need a mask, in one process, so that few words live at a time.
// Any Width from 2. Combinational; as many full-adder delays as digits, and two carry-propagate adders.
// Source: O. L. MacSorley, "High-speed arithmetic in binary computers", Proc. IRE 49, 1961.
module booth_array_multiplier #(
  parameter int unsigned Width = 24
) (
  input  logic [Width-1:0]   a_i,
  input  logic [Width-1:0]   b_i,
  output logic [2*Width-1:0] product_o
);

  localparam int unsigned Digits = Width / 3 + 1;
  localparam int unsigned WordWidth = (Width <= 32) ? 64 : 2 * Width;
  localparam logic [WordWidth-1:0] EveryThird = WordWidth'({Digits{3'b001}});

  // Multiples, by the four bits of b_i that make a digit; of negative ones the complement, which lacks 1

  logic [WordWidth-1:0] once, thrice;
  logic [WordWidth-1:0] multiples[16];

  assign once   = WordWidth'(a_i);
  assign thrice = once + (once << 1);

  always_comb begin
    multiples[0]  = '0;
    multiples[1]  = once;
    multiples[2]  = once;
    multiples[3]  = once << 1;
    multiples[4]  = once << 1;
    multiples[5]  = thrice;
    multiples[6]  = thrice;
    multiples[7]  = once << 2;
    multiples[8]  = ~(once << 2);
    multiples[9]  = ~thrice;
    multiples[10] = ~thrice;
    multiples[11] = ~(once << 1);
    multiples[12] = ~(once << 1);
    multiples[13] = ~once;
    multiples[14] = ~once;
    multiples[15] = '1;
  end

  // Add: first what the complements lack, a 1 at bit 3k for each digit with b[3k+2]

  logic [WordWidth-1:0] digits;

  assign digits = WordWidth'({b_i, 1'b0});

  always_comb begin : add
    logic [WordWidth-1:0] sum, carry, row, half;
    sum   = EveryThird & (WordWidth'(b_i) >> 2);
    carry = multiples[digits[3:0]];
    for (int unsigned k = 1; k < Digits; k++) begin
      row   = multiples[digits[3*k+:4]] << 3 * k;
      half  = sum ^ carry;
      carry = (((sum ^ row) & half) ^ sum) << 1;  // the majority
      sum   = half ^ row;
    end
    product_o = (2 * Width)'(sum + carry);
  end

endmodule
