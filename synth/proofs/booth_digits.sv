// Composition of the multiplier's proof, step 1. Claim: operand b is the sum over k of digit[k] * 4**k, for the recoded
// digits from -2 to 2. Also, `one` and `two` are never both set for a digit, and the last digit is not negative.
module booth_digits #(
  parameter int unsigned Width = 24,
  localparam int unsigned Digits = Width / 2 + 1
) (
  input logic [Width-1:0] b
);

  logic [2*Digits-1:0] one, two, negative;

  booth_encoder #(
    .Width(Width)
  ) dut (
    .b_i       (b),
    .one_o     (one),
    .two_o     (two),
    .negative_o(negative)
  );

  // The arithmetic is modulo 4**Digits; all values are below 4**Digits.
  logic [2*Digits-1:0] magnitude, sum;
  always_comb begin
    sum = '0;
    for (int unsigned k = 0; k < Digits; k++) begin
      magnitude = {{(2*Digits-2){1'b0}}, two[2*k], one[2*k]} << 2 * k;
      sum = negative[2*k] ? sum - magnitude : sum + magnitude;
    end
  end

  always_comb begin
    assert (sum == (2 * Digits)'(b));
    assert ((one & two) == '0);
    assert (((one | two | negative) & {Digits{2'b10}}) == '0);
    assert (!negative[2*Digits-2]);
  end

endmodule
