// Floating-point add and subtract: a_i + b_i, or a_i - b_i with subtract_i.
//
// Two paths, of which the second needs no rounding and the first no long normalising shift:
//   far   the smaller operand shifted right, one addition, the shared rounder
//   near  a difference of operands whose exponents are equal, or are neighbours and cancel at least
//         the leading bit: exact, so only a leading-zero count and a left shift
//
// Combinational. Takes every bit pattern. Correctly rounded; a sum of exactly zero is +0, or -0
// when rounding down, unless both addends are zeros of one sign. Infinity minus infinity is
// invalid. A subnormal sum is exact, so underflow is never raised and tininess_after_i changes
// nothing.
// Source: IEEE 754-2019, clauses 5.4.1 and 6.3; the two paths: Farmwald, Stanford 1981.
module fp_adder #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Adder     = arith_pkg::AdderGraded
) (
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  logic                        subtract_i,
  input  fp_pkg::rounding_mode_e      rounding_mode_i,
  input  logic                        tininess_after_i,
  output logic [ExpWidth+FracWidth:0] result_o,
  output fp_pkg::flags_t              flags_o
);

  localparam int unsigned SigWidth = FracWidth + 1;  // significand with its integer bit
  localparam int unsigned NearWidth = FracWidth + 2;  // one place more, for a neighbour exponent
  localparam int unsigned FarWidth = FracWidth + 3;  // two integer bits, fraction, guard
  localparam int unsigned ShiftWidth = $clog2(FarWidth + 1);
  localparam int unsigned CountWidth = $clog2(NearWidth);

  // ---- Unpack; subtracting is adding with the other sign

  logic a_sign, b_sign_packed, b_sign, subtract;
  logic [ExpWidth-1:0] a_exp, b_exp;
  logic [SigWidth-1:0] a_sig, b_sig;
  logic a_zero, a_inf, a_nan, a_snan, b_zero, b_inf, b_nan, b_snan;

  fp_unpack #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth)
  ) u_unpack_a (
    .packed_i(a_i),
    .sign_o(a_sign),
    .exponent_o(a_exp),
    .significand_o(a_sig),
    .zero_o(a_zero),
    .infinity_o(a_inf),
    .nan_o(a_nan),
    .signaling_nan_o(a_snan)
  );
  fp_unpack #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth)
  ) u_unpack_b (
    .packed_i(b_i),
    .sign_o(b_sign_packed),
    .exponent_o(b_exp),
    .significand_o(b_sig),
    .zero_o(b_zero),
    .infinity_o(b_inf),
    .nan_o(b_nan),
    .signaling_nan_o(b_snan)
  );
  assign b_sign = b_sign_packed ^ subtract_i;
  assign subtract = a_sign ^ b_sign;  // of the magnitudes

  // ---- Order by magnitude, so that no difference is negative

  logic swap, equal, sign;
  logic [ExpWidth-1:0] big_exp;
  logic [SigWidth-1:0] big_sig, small_sig;

  comparator #(
    .Width(ExpWidth + FracWidth)
  ) u_order (
    .a_i(a_i[ExpWidth+FracWidth-1:0]),
    .b_i(b_i[ExpWidth+FracWidth-1:0]),
    .less_o(swap),
    .equal_o(equal)
  );
  assign big_exp = swap ? b_exp : a_exp;
  assign {big_sig, small_sig} = swap ? {b_sig, a_sig} : {a_sig, b_sig};
  assign sign = (equal & subtract) ? rounding_mode_i == fp_pkg::RoundDown : swap ? b_sign : a_sign;

  // ---- Distance of the exponents, both ways at once beside the ordering

  logic [ExpWidth-1:0] a_minus_b, b_minus_a, distance;
  logic distance_is_0, distance_is_1;
  logic [1:0] unused_distance_carry;

  adder #(
    .Width(ExpWidth),
    .Adder(Adder)
  ) u_a_minus_b (
    .a_i(a_exp),
    .b_i(~b_exp),
    .carry_i(1'b1),
    .sum_o(a_minus_b),
    .carry_o(unused_distance_carry[0])
  );
  adder #(
    .Width(ExpWidth),
    .Adder(Adder)
  ) u_b_minus_a (
    .a_i(b_exp),
    .b_i(~a_exp),
    .carry_i(1'b1),
    .sum_o(b_minus_a),
    .carry_o(unused_distance_carry[1])
  );
  assign distance = swap ? b_minus_a : a_minus_b;
  assign distance_is_0 = a_exp == b_exp;
  assign distance_is_1 = distance == ExpWidth'(1);

  // ---- Far path: align. A difference is taken one place further left: its value, doubled, is in
  // [1, 4) like that of a sum (but for those that the near path gives), and its exponent one less.

  logic [FarWidth-1:0] far_big, far_small, far_aligned, far_lost;
  logic [ShiftWidth-1:0] far_shift;
  logic far_sticky;

  assign far_big = subtract ? {big_sig, 2'b00} : {1'b0, big_sig, 1'b0};
  assign far_small = subtract ? {small_sig, 2'b00} : {1'b0, small_sig, 1'b0};
  assign far_shift = (distance > ExpWidth'(2 ** ShiftWidth - 1)) ? '1 : distance[ShiftWidth-1:0];
  assign far_aligned = far_small >> far_shift;
  assign far_lost = far_small & ~({FarWidth{1'b1}} << far_shift);
  assign far_sticky = |far_lost;

  // ---- Far path: add. A lost part of the subtrahend takes the place of the one that completes its
  // complement: the difference is then too low by less than a place, which the sticky bit tells.

  logic [FarWidth-1:0] far_sum;
  logic unused_far_carry;

  adder #(
    .Width(FarWidth),
    .Adder(Adder)
  ) u_far_sum (
    .a_i(far_big),
    .b_i(far_aligned ^ {FarWidth{subtract}}),
    .carry_i(subtract & ~far_sticky),
    .sum_o(far_sum),
    .carry_o(unused_far_carry)
  );

  // ---- Far path: exponent for the rounder, less one for a sum and less two for a difference

  logic [ExpWidth-1:0] exp_plus_1_n, exp_plus_2_n, far_exp;  // complements count downwards

  incrementer #(
    .Width(ExpWidth)
  ) u_exp_less_1 (
    .a_i(~big_exp),
    .carry_i(1'b1),
    .sum_o(exp_plus_1_n)
  );
  incrementer #(
    .Width(ExpWidth - 1)
  ) u_exp_less_2 (
    .a_i(~big_exp[ExpWidth-1:1]),
    .carry_i(1'b1),
    .sum_o(exp_plus_2_n[ExpWidth-1:1])
  );
  assign exp_plus_2_n[0] = ~big_exp[0];
  assign far_exp = ~(subtract ? exp_plus_2_n : exp_plus_1_n);

  // ---- Near path: subtract, the distance known from the exponents' lowest bits

  logic [NearWidth-1:0] near_small, near_difference;
  logic unused_near_carry;

  assign near_small = (a_exp[0] ^ b_exp[0]) ? {1'b0, small_sig} : {small_sig, 1'b0};

  adder #(
    .Width(NearWidth),
    .Adder(Adder)
  ) u_near_difference (
    .a_i({big_sig, 1'b0}),
    .b_i(~near_small),
    .carry_i(1'b1),
    .sum_o(near_difference),
    .carry_o(unused_near_carry)
  );

  // ---- Near path: normalise. A mark at the place where the exponent becomes the smallest one
  // stops the count there: what is left is subnormal, or zero, and has the exponent field 0.

  logic [NearWidth-1:0] near_mark, near_normal;
  logic [CountWidth-1:0] near_count;
  logic [ExpWidth-1:0] near_shift, near_exp;
  logic [ExpWidth+FracWidth-1:0] near_magnitude;
  logic unused_near_exp_carry, unused_near_bit, unused_near_zero;

  assign near_mark = NearWidth'({1'b1, {NearWidth{1'b0}}} >> big_exp);

  leading_zero_counter #(
    .Width(NearWidth)
  ) u_near_count (
    .a_i(near_difference | near_mark),
    .count_o(near_count),
    .zero_o(unused_near_zero)
  );
  assign near_shift = ExpWidth'(near_count);
  adder #(
    .Width(ExpWidth),
    .Adder(Adder)
  ) u_near_exp (
    .a_i(big_exp),
    .b_i(~near_shift),
    .carry_i(1'b1),
    .sum_o(near_exp),
    .carry_o(unused_near_exp_carry)
  );
  assign near_normal = near_difference << near_count;
  assign unused_near_bit = near_normal[0];  // 0 whenever this path is taken
  assign near_magnitude = {near_exp & {ExpWidth{near_normal[NearWidth-1]}},
                           near_normal[NearWidth-2:1]};

  // ---- Specials, rounding of the far path, choice of the path

  logic near, nan, infinity, invalid, unused_zero;
  logic [ExpWidth+FracWidth:0] far_result;
  fp_pkg::flags_t far_flags;

  assign nan = a_nan | b_nan | (a_inf & b_inf & subtract);
  assign invalid = a_snan | b_snan | (a_inf & b_inf & subtract);
  assign infinity = a_inf | b_inf;
  assign unused_zero = a_zero ^ b_zero;  // zeros need no special care
  assign near = subtract & ~nan & ~infinity
              & (distance_is_0 | (distance_is_1 & ~near_difference[NearWidth-1]));

  fp_round #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .SubnormalShift(1'b0)
  ) u_round (
    .sign_i(sign),
    .exponent_i({2'b00, far_exp}),
    .significand_i({far_sum, 1'b0, far_sticky}),
    .nan_i(nan),
    .infinity_i(infinity),
    .zero_i(1'b0),
    .invalid_i(invalid),
    .divide_by_zero_i(1'b0),
    .rounding_mode_i,
    .tininess_after_i,
    .result_o(far_result),
    .flags_o(far_flags)
  );
  assign result_o = near ? {sign, near_magnitude} : far_result;
  assign flags_o = near ? 5'b00000 : far_flags;

endmodule
