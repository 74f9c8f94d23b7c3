// Floating-point add and subtract: a_i + b_i, or a_i - b_i with subtract_i.
//
// There are two paths; the second needs no rounding and the first no long normalising shift:
//   far   the smaller operand is shifted right; then one addition, and rounding by fp_round
//   near  for a difference of operands whose exponents are equal, or differ by 1 while the leading bit cancels. The
//         difference is exact, so it needs only a leading-zero count and a left shift.
//
// Pipelined: registers between ordering and adding, between adding and rounding, and after the result. Latency: 0 or,
// Pipelined, 3 clocks. Throughput: one operation a clock. Several stages use rounding_mode_i, so it must not change
// while operations are in flight.
//
// Takes every bit pattern. Correctly rounded. A sum of two zeros of one sign keeps the sign; any other sum of exactly
// zero is +0, or -0 when rounding down. Infinity minus infinity is invalid. A subnormal sum is exact, so underflow is
// never raised and tininess_after_i has no effect.
// Source: IEEE 754-2019, clauses 5.4.1 and 6.3; the two paths: Farmwald, Stanford 1981.
module fp_adder #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = arith_pkg::Graded,
  parameter bit          Pipelined = 1'b0
) (
  input  logic                        clk_i,
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  logic                        subtract_i,
  input  logic [2:0]                  rounding_mode_i,
  input  logic                        tininess_after_i,
  output logic [ExpWidth+FracWidth:0] result_o,
  output fp_pkg::flags_t              flags_o
);

  localparam int unsigned SigWidth = FracWidth + 1;  // significand with its integer bit
  localparam int unsigned NearWidth = FracWidth + 2;  // one more, for exponents one apart
  localparam int unsigned FarWidth = FracWidth + 3;  // two integer bits, fraction, guard
  localparam int unsigned CountWidth = $clog2(NearWidth);

  // ---- Unpack; subtraction inverts b's sign

  logic a_sign, b_sign_packed, b_sign, subtract;
  logic [ExpWidth-1:0] a_exp, b_exp;
  logic [SigWidth-1:0] a_sig, b_sig;
  fp_pkg::class_t a_class, b_class;

  fp_unpack #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth)
  ) u_unpack (
    .packed_i({b_i, a_i}),
    .sign_o({b_sign_packed, a_sign}),
    .exponent_o({b_exp, a_exp}),
    .significand_o({b_sig, a_sig}),
    .class_o({b_class, a_class})
  );
  assign b_sign = b_sign_packed ^ subtract_i;
  assign subtract = a_sign ^ b_sign;  // magnitudes are subtracted

  // ---- Order by magnitude, so that no difference is negative

  logic swap, equal, sign;
  logic [ExpWidth-1:0] big_exp;
  logic [SigWidth-1:0] big_sig, small_sig;

  assign swap = a_i[ExpWidth+FracWidth-1:0] < b_i[ExpWidth+FracWidth-1:0];
  assign equal = a_i[ExpWidth+FracWidth-1:0] == b_i[ExpWidth+FracWidth-1:0];
  assign big_exp = swap ? b_exp : a_exp;
  assign big_sig = swap ? b_sig : a_sig;
  assign small_sig = swap ? a_sig : b_sig;
  assign sign = (equal & subtract) ? rounding_mode_i == fp_pkg::RoundDown : swap ? b_sign : a_sign;

  // ---- Distance of the exponents: both differences, in parallel with the ordering

  logic [1:0][ExpWidth-1:0] exps, differences;  // [0]: a, a - b; [1]: b, b - a
  logic [ExpWidth-1:0] distance;

  assign exps = {b_exp, a_exp};
  for (genvar n = 0; n < 2; n++) begin : gen_difference
    adder #(
      .Width(ExpWidth),
      .Arith(Arith)
    ) u_difference (
      .a_i(exps[n]),
      .b_i(~exps[1-n]),
      .carry_i(1'b1),
      .sum_o(differences[n]),
      .carry_o()
    );
  end
  assign distance = swap ? differences[1] : differences[0];

  // ---- First register

  logic sign_1, subtract_1, odd_1, near_0_1, near_1_1, odd, near_0, near_1, ordinary;
  logic [ExpWidth-1:0] big_exp_1, distance_1;
  logic [SigWidth-1:0] big_sig_1, small_sig_1;
  fp_pkg::special_t special, special_1;

  assign odd = a_exp[0] ^ b_exp[0];

  always_comb begin
    special = '0;
    if (a_class.special | b_class.special) begin
      special.invalid = a_class.signaling_nan | b_class.signaling_nan
                      | (a_class.infinity & b_class.infinity & subtract);
      special.nan = a_class.nan | b_class.nan | special.invalid;
      special.infinity = a_class.infinity | b_class.infinity;
    end
  end
  assign ordinary = ~special.nan & ~special.infinity;
  assign near_0 = subtract & ordinary & (distance == '0);
  assign near_1 = subtract & ordinary & (distance == ExpWidth'(1));

  delay_line #(
    .Width(2 * (ExpWidth + SigWidth) + 5 + $bits(special)),
    .Depth(32'(Pipelined))
  ) u_ordered (
    .clk_i,
    .enable_i(1'b1),
    .data_i({sign, subtract, odd, near_0, near_1, special, big_exp, distance, big_sig, small_sig}),
    .data_o({sign_1, subtract_1, odd_1, near_0_1, near_1_1, special_1, big_exp_1, distance_1,
             big_sig_1, small_sig_1})
  );

  // ---- Far path: align. For a subtraction, the operands are shifted left by one and the exponent is one less. So a
  // difference is in [1, 4), like a sum, unless the near path computes it.

  logic [FarWidth-1:0] far_big, far_small, far_aligned;
  logic far_sticky;

  assign far_big = subtract_1 ? {big_sig_1, 2'b00} : {1'b0, big_sig_1, 1'b0};
  assign far_small = subtract_1 ? {small_sig_1, 2'b00} : {1'b0, small_sig_1, 1'b0};
  sticky_right_shift #(
    .Width(FarWidth),
    .AmountWidth(ExpWidth)
  ) u_align (
    .a_i(far_small),
    .amount_i(distance_1),
    .shifted_o(far_aligned),
    .lost_o(far_sticky)
  );

  // ---- Far path: add. If bits of the subtrahend are lost, the +1 of its two's complement is left out. far_sum is then
  // below the exact difference by less than a unit in its last place; the sticky bit represents this rest.

  logic [FarWidth-1:0] far_sum;

  adder #(
    .Width(FarWidth),
    .Arith(Arith)
  ) u_far_sum (
    .a_i(far_big),
    .b_i(far_aligned ^ {FarWidth{subtract_1}}),
    .carry_i(subtract_1 & ~far_sticky),
    .sum_o(far_sum),
    .carry_o()
  );

  // ---- Far path: exponent for fp_round, big_exp - 1 for a sum and big_exp - 2 for a difference

  logic [ExpWidth-1:0] far_exp;

  assign far_exp = big_exp_1 - (subtract_1 ? ExpWidth'(2) : ExpWidth'(1));

  // ---- Near path: subtract; exponents differ by 0 or 1, so their lowest bits suffice to align

  logic [NearWidth-1:0] near_small, near_difference;

  assign near_small = odd_1 ? {1'b0, small_sig_1} : {small_sig_1, 1'b0};

  adder #(
    .Width(NearWidth),
    .Arith(Arith)
  ) u_near_difference (
    .a_i({big_sig_1, 1'b0}),
    .b_i(~near_small),
    .carry_i(1'b1),
    .sum_o(near_difference),
    .carry_o()
  );

  // A 1 at the bit that becomes the integer bit if the shift lowers the exponent to the smallest one.
  logic [NearWidth-1:0] near_mark;
  logic near;

  assign near_mark = NearWidth'({1'b1, {NearWidth{1'b0}}} >> big_exp_1);
  assign near = near_0_1 | (near_1_1 & ~near_difference[NearWidth-1]);

  // ---- Second register

  logic sign_2, near_2, far_sticky_2;
  logic [ExpWidth-1:0] big_exp_2, far_exp_2;
  logic [FarWidth-1:0] far_sum_2;
  logic [NearWidth-1:0] near_difference_2, near_mark_2;
  fp_pkg::special_t special_2;

  delay_line #(
    .Width(2 * ExpWidth + FarWidth + 2 * NearWidth + 3 + $bits(special)),
    .Depth(32'(Pipelined))
  ) u_added (
    .clk_i,
    .enable_i(1'b1),
    .data_i({sign_1, near, special_1, far_sticky, big_exp_1, far_exp, far_sum, near_difference,
             near_mark}),
    .data_o({sign_2, near_2, special_2, far_sticky_2, big_exp_2, far_exp_2, far_sum_2,
             near_difference_2, near_mark_2})
  );

  // ---- Near path: normalise. near_mark stops the zero count where the exponent becomes the smallest one. The result
  // is then subnormal or zero, with an exponent field of 0. On the far path, the count is 0 and the result is not used.

  logic [NearWidth-1:0] near_normal;
  logic [CountWidth-1:0] near_count;
  logic [ExpWidth-1:0] near_shift, near_exp;
  logic [ExpWidth+FracWidth-1:0] near_magnitude;
  logic unused_near_bit;

  leading_zero_counter #(
    .Width(NearWidth)
  ) u_near_count (
    .a_i(near_difference_2 | near_mark_2 | {~near_2, {(NearWidth - 1) {1'b0}}}),
    .count_o(near_count),
    .zero_o()
  );
  assign near_shift = ExpWidth'(near_count);
  adder #(
    .Width(ExpWidth),
    .Arith(Arith)
  ) u_near_exp (
    .a_i(big_exp_2),
    .b_i(~near_shift),
    .carry_i(1'b1),
    .sum_o(near_exp),
    .carry_o()
  );
  assign near_normal = near_difference_2 << near_count;
  assign unused_near_bit = near_normal[0];  // 0 whenever this path is taken
  assign near_magnitude = {near_exp & {ExpWidth{near_normal[NearWidth-1]}},
                           near_normal[NearWidth-2:1]};

  // ---- Rounding of the far path, choice of the path

  logic [ExpWidth+FracWidth:0] far_result, result;
  fp_pkg::flags_t far_flags, flags;
  logic unused_zero;

  fp_round #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .SubnormalShift(1'b0)
  ) u_round (
    .sign_i(sign_2),
    .exponent_i({2'b00, far_exp_2}),
    .significand_i({far_sum_2, 1'b0, far_sticky_2}),
    .special_i(special_2),
    .rounding_mode_i,
    .tininess_after_i,
    .result_o(far_result),
    .flags_o(far_flags)
  );
  assign result = near_2 ? {sign_2, near_magnitude} : far_result;
  assign flags = near_2 ? 5'b00000 : far_flags;
  assign unused_zero = a_class.zero ^ b_class.zero;  // zeros need no special care

  // ---- Last register

  delay_line #(
    .Width(ExpWidth + FracWidth + 1),
    .Depth(32'(Pipelined))
  ) u_result (
    .clk_i,
    .enable_i(1'b1),
    .data_i(result),
    .data_o(result_o)
  );
  delay_line #(
    .Width($bits(flags)),
    .Depth(32'(Pipelined))
  ) u_flags (  // separate, so that Verilator can drop unused flags
    .clk_i,
    .enable_i(1'b1),
    .data_i(flags),
    .data_o(flags_o)
  );

endmodule
