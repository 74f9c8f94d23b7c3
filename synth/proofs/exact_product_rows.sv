// Claims, modulo 2**Width: d[k] = -2 b[2k+1] + b[2k] + b[2k-1] are the Booth digits of b, negated if `negate`. n[k] is
// bit 2k of `turned`, set for complemented rows. Word k of exact_product's tree is
//   (d[k] a - n[k] + 2**DigitWidth) 4**k, and the last word is the sum over k of (n[k] - 2**DigitWidth) 4**k.
// The sum of d[k] 4**k is b, or -b if `negate`. opened_exact_product has `rows` and `turned` as outputs.
module exact_product_rows #(
  parameter int unsigned DigitWidth = 48,
  parameter int unsigned Width = 103,
  localparam int unsigned Rows = DigitWidth / 2
) (
  input logic [DigitWidth-1:0] a,
  input logic [DigitWidth-1:0] b,
  input logic negate
);

  logic [Width-1:0] sum, carry, total;
  logic [Width*(Rows+1)-1:0] rows;
  logic [DigitWidth-1:0] turned;
  logic signed [Width-1:0] wide_a, digits[Rows], multiples[Rows], wide_b, recoded, signs;

  opened_exact_product dut (
    .a_i     (a),
    .b_i     (b),
    .negate_i(negate),
    .sum_o   (sum),
    .carry_o (carry),
    .\gen_booth.rows (rows),
    .\gen_booth.turned (turned)
  );

  assign wide_a = $signed(a);
  assign wide_b = $signed(b);
  always_comb begin
    recoded = '0;
    signs   = '0;
    for (int unsigned k = 0; k < Rows; k++) begin
      digits[k] = Width'(b[2*k]) + ((k == 0) ? '0 : Width'(b[2*k-1])) - (Width'(b[2*k+1]) << 1);
      if (negate) digits[k] = -digits[k];
      multiples[k] = (digits[k] == 1) ? wide_a : (digits[k] == 2) ? wide_a <<< 1 : (digits[k] == -1) ? -wide_a
                   : (digits[k] == -2) ? -(wide_a <<< 1) : '0;
      recoded = recoded + (digits[k] <<< 2 * k);
      signs   = signs + ((Width'(turned[2*k]) - (Width'(1) << DigitWidth)) << 2 * k);
    end
  end

  for (genvar k = 0; k < Rows; k++) begin : gen_row
    always_comb begin
      assert (rows[Width*k+:Width]
              == $unsigned(multiples[k] - Width'(turned[2*k]) + (Width'(1) << DigitWidth)) << 2 * k);
    end
  end
  always_comb begin
    assert (rows[Width*Rows+:Width] == $unsigned(signs));
    assert (recoded == (negate ? -wide_b : wide_b));
  end

endmodule
