// Floating-point divide: a_i / b_i.
//
// Unpack, normalise subnormals, divide the significands digit by digit (srt_divider), round.
//
// QuotientBits = 0 is IEEE 754: correctly rounded. Other values reproduce a divider whose
// significand is cut off, not rounded, after that many bits, counting the leading one (21 gives the
// quotients printed in the paper's worked example, up to 5 ulp low in binary32). Only a subnormal
// result is then still rounded, from what the cut has left; what was cut off raises no flag.
//
// Combinational. Takes every bit pattern. A finite number by zero is infinity and raises
// divide_by_zero; 0/0 and inf/inf are invalid.
// Source: IEEE 754-2019, clauses 5.4.1 and 7; Choi and Chung, Trans. KIEE 48A-5-21, section 4.2.
module fp_divider #(
  parameter int unsigned ExpWidth     = 8,
  parameter int unsigned FracWidth    = 23,
  parameter int unsigned Adder        = arith_pkg::AdderGraded,
  parameter int unsigned QuotientBits = 0
) (
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  fp_pkg::rounding_mode_e      rounding_mode_i,
  input  logic                        tininess_after_i,
  output logic [ExpWidth+FracWidth:0] result_o,
  output fp_pkg::flags_t              flags_o
);

  localparam int unsigned SigWidth = FracWidth + 1;  // significand with its integer bit
  localparam int unsigned CountWidth = $clog2(FracWidth + 1);
  localparam int unsigned RoundExpWidth = ExpWidth + 2;  // the rounder's exponent
  // Fraction bits of a quotient in [1, 4): where it is below 2, all of the significand's and the
  // guard bit, or as many as are not cut off. Two a row.
  localparam int unsigned QuotientFrac = (QuotientBits == 0) ? FracWidth + 1 : QuotientBits - 1;
  localparam int unsigned Rows = (QuotientFrac + 1) / 2;
  localparam int unsigned QuotientWidth = 2 * Rows + 2;
  localparam int unsigned RoundSigWidth = FracWidth + 5;  // of the rounder

  if (QuotientBits > FracWidth + 1) begin : gen_check
    $error("fp_divider: QuotientBits is 0 or at most the significand's FracWidth + 1");
  end

  // ---- Unpack

  logic a_sign, b_sign;
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
    .sign_o(b_sign),
    .exponent_o(b_exp),
    .significand_o(b_sig),
    .zero_o(b_zero),
    .infinity_o(b_inf),
    .nan_o(b_nan),
    .signaling_nan_o(b_snan)
  );

  // ---- Normalise

  logic [SigWidth-1:0] a_norm, b_norm;
  logic [CountWidth-1:0] a_count, b_count;

  fp_normalize #(
    .Width(SigWidth)
  ) u_normalize_a (
    .significand_i(a_sig),
    .significand_o(a_norm),
    .count_o(a_count)
  );
  fp_normalize #(
    .Width(SigWidth)
  ) u_normalize_b (
    .significand_i(b_sig),
    .significand_o(b_norm),
    .count_o(b_count)
  );

  // ---- Exponent for the rounder: that of a/b, less one because the quotient comes doubled, less
  // one because the rounder wants it so: (a_exp - a_count) - (b_exp - b_count) + bias - 2

  localparam logic [RoundExpWidth-1:0] Offset = RoundExpWidth'(2 ** (ExpWidth - 1) - 3);
  logic [RoundExpWidth-1:0] a_exp_offset, exp_difference, count_difference, exponent;
  logic [RoundExpWidth-1:0] a_count_wide, b_count_wide;
  logic [3:0] unused_carry;

  assign a_count_wide = RoundExpWidth'(a_count);
  assign b_count_wide = RoundExpWidth'(b_count);
  adder #(
    .Width(RoundExpWidth),
    .Adder(Adder)
  ) u_offset (
    .a_i({2'b00, a_exp}),
    .b_i(Offset),
    .carry_i(1'b0),
    .sum_o(a_exp_offset),
    .carry_o(unused_carry[0])
  );
  adder #(
    .Width(RoundExpWidth),
    .Adder(Adder)
  ) u_exp_difference (
    .a_i(a_exp_offset),
    .b_i(~{2'b00, b_exp}),
    .carry_i(1'b1),
    .sum_o(exp_difference),
    .carry_o(unused_carry[1])
  );
  adder #(
    .Width(RoundExpWidth),
    .Adder(Adder)
  ) u_count_difference (
    .a_i(b_count_wide),
    .b_i(~a_count_wide),
    .carry_i(1'b1),
    .sum_o(count_difference),
    .carry_o(unused_carry[2])
  );
  adder #(
    .Width(RoundExpWidth),
    .Adder(Adder)
  ) u_exponent (
    .a_i(exp_difference),
    .b_i(count_difference),
    .carry_i(1'b0),
    .sum_o(exponent),
    .carry_o(unused_carry[3])
  );

  // ---- Divide: the doubled quotient, in (1, 4)

  logic [QuotientWidth-1:0] quotient;
  logic remainder;

  srt_divider #(
    .Width(SigWidth),
    .Rows(Rows),
    .Adder(Adder)
  ) u_divide (
    .dividend_i(a_norm),
    .divisor_i(b_norm),
    .quotient_o(quotient),
    .remainder_o(remainder)
  );

  // ---- Place it for the rounder; or cut it off, one place further down where it is below 2

  logic [RoundSigWidth-1:0] significand;

  if (QuotientBits == 0) begin : gen_ieee
    assign significand = {quotient, {(RoundSigWidth - QuotientWidth - 1) {1'b0}}, remainder};
  end else begin : gen_cut_off
    localparam logic [QuotientWidth-1:0] Ones = '1;
    localparam logic [QuotientWidth-1:0] KeepFrom2 = Ones << (QuotientWidth - QuotientBits);
    localparam logic [QuotientWidth-1:0] KeepFrom1 = Ones << (QuotientWidth - 1 - QuotientBits);
    logic unused_remainder;
    assign unused_remainder = remainder;
    assign significand = {quotient & (quotient[QuotientWidth-1] ? KeepFrom2 : KeepFrom1),
                          {(RoundSigWidth - QuotientWidth) {1'b0}}};
  end

  // ---- Specials, rounding

  logic nan, invalid, by_zero;

  assign invalid = a_snan | b_snan | (a_zero & b_zero) | (a_inf & b_inf);
  assign nan = a_nan | b_nan | invalid;
  assign by_zero = b_zero & ~a_zero & ~a_inf & ~a_nan;

  fp_round #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth)
  ) u_round (
    .sign_i(a_sign ^ b_sign),
    .exponent_i(exponent),
    .significand_i(significand),
    .nan_i(nan),
    .infinity_i(a_inf | b_zero),
    .zero_i(a_zero | b_inf),
    .invalid_i(invalid),
    .divide_by_zero_i(by_zero),
    .rounding_mode_i,
    .tininess_after_i,
    .result_o,
    .flags_o
  );

endmodule
