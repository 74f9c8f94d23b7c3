// Composition of the multiplier's proof, step 4. Claim: a carry-save adder preserves the sum: a + b + c = sum + carry.
module carry_save_preserves #(
  parameter int unsigned Width = 48
) (
  input logic [Width-1:0] a,
  input logic [Width-1:0] b,
  input logic [Width-1:0] c
);

  logic [Width-1:0] sum, carry;

  carry_save_adder #(
    .Width(Width)
  ) dut (
    .a_i    (a),
    .b_i    (b),
    .c_i    (c),
    .sum_o  (sum),
    .carry_o(carry)
  );

  always_comb assert (sum + carry == a + b + c);

endmodule
