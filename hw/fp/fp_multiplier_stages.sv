// Floating-point multiply, a_i * b_i, in up to three stages.
//
// The significands go into the multiplier as they are, a subnormal one with its leading zeros; how
// far the product must move is found from the operands alone, beside the multiplication: to the
// left by the leading zeros, but not beyond the smallest exponent, or to the right for a subnormal
// result. Behind the multiplier are left one shift and the shared rounder.
//
// Arith, Adder: see arith_pkg. ConstantRow: 1 for the paper's carry-save tree, see booth_multiplier.
// PipeRegs: registers behind the product (bit 0), behind the result (bit 1) and before the product (bit 2). As many
// clocks of latency as registers, one operation a clock; none: combinational. The rounding mode is the last stage's.
//
// Takes every bit pattern. Correctly rounded; the sign is the exclusive OR of the
// operands' signs, also that of zeros and infinities. Zero times infinity is invalid.
// Source: IEEE 754-2019, clause 5.4.1; the paper's multiplier, section 3.4.
module fp_multiplier_stages #(
  parameter int unsigned ExpWidth    = 8,
  parameter int unsigned FracWidth   = 23,
  parameter int unsigned Arith       = arith_pkg::Structural,
  parameter int unsigned Adder       = arith_pkg::AdderGraded,
  parameter bit          ConstantRow = 1'b0,
  parameter bit [2:0]    PipeRegs    = 3'b000
) (
  input  logic                        clk_i,
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  logic [2:0]                  rounding_mode_i,
  input  logic                        tininess_after_i,
  output logic [ExpWidth+FracWidth:0] result_o,
  output fp_pkg::flags_t              flags_o
);

  localparam int unsigned SigWidth = FracWidth + 1;  // significand with its integer bit
  localparam int unsigned ProdWidth = 2 * SigWidth;  // two integer bits
  localparam int unsigned LeftWidth = $clog2(SigWidth);

  // ---- Unpack

  logic a_sign, b_sign;
  logic [ExpWidth-1:0] a_exp, b_exp;
  logic [SigWidth-1:0] a_sig, b_sig;
  logic a_special, a_zero, a_inf, a_nan, a_snan, b_special, b_zero, b_inf, b_nan, b_snan;

  fp_unpack #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth)
  ) u_unpack_a (
    .packed_i(a_i),
    .sign_o(a_sign),
    .exponent_o(a_exp),
    .significand_o(a_sig),
    .special_o(a_special),
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
    .special_o(b_special),
    .zero_o(b_zero),
    .infinity_o(b_inf),
    .nan_o(b_nan),
    .signaling_nan_o(b_snan)
  );

  // ---- Add the exponents: the biased exponent of the product less one, as the rounder wants it, is
  // a_exp + b_exp - bias - 1 = a_exp + b_exp - 2**(ExpWidth-1), which leaves the low bits alone.

  logic [ExpWidth:0] exp_sum, exp;
  logic exp_negative, unused_exp_carry;

  adder #(
    .Width(ExpWidth + 1),
    .Arith(Arith),
    .Adder(Adder)
  ) u_exp_sum (
    .a_i({1'b0, a_exp}),
    .b_i({1'b0, b_exp}),
    .carry_i(1'b0),
    .sum_o(exp_sum),
    .carry_o(unused_exp_carry)
  );
  assign exp_negative = exp_sum[ExpWidth:ExpWidth-1] == 2'b00;
  assign exp = exp_sum ^ {~exp_sum[ExpWidth-1], 1'b1, {(ExpWidth - 1) {1'b0}}};

  // ---- Specials

  logic sign, nan, infinity, zero, invalid;

  assign sign = a_sign ^ b_sign;

  always_comb begin
    {nan, infinity, zero, invalid} = 4'b0000;
    if (a_special | b_special) begin
      invalid = a_snan | b_snan | (a_inf & b_zero) | (a_zero & b_inf);
      nan = a_nan | b_nan | invalid;
      infinity = a_inf | b_inf;
      zero = a_zero | b_zero;
    end
  end

  // ---- Cut before the product

  logic [SigWidth-1:0] a_sig_0, b_sig_0;
  logic [ExpWidth:0] exp_0;
  logic exp_negative_0;
  logic [4:0] specials_0;

  delay_line #(
    .Width(2 * SigWidth + ExpWidth + 7),
    .Depth(32'(PipeRegs[2]))
  ) u_operands (
    .clk_i,
    .enable_i(1'b1),
    .data_i({a_sig, b_sig, exp, exp_negative, sign, nan, infinity, zero, invalid}),
    .data_o({a_sig_0, b_sig_0, exp_0, exp_negative_0, specials_0})
  );

  // ---- Multiply the significands: in [1, 4) if both are normal

  logic [ProdWidth-1:0] product;

  multiplier #(
    .Width(SigWidth),
    .Arith(Arith),
    .Adder(Adder),
    .ConstantRow(ConstantRow)
  ) u_multiplier (
    .a_i(a_sig_0),
    .b_i(b_sig_0),
    .product_o(product)
  );

  // ---- Left shift: the leading zeros of the subnormal operand, if there is one (the product of two
  // is far below the smallest subnormal). A mark stops the count where the exponent is the smallest.

  logic [SigWidth-1:0] may_be_subnormal, mark;
  logic [LeftWidth-1:0] left;
  logic unused_zero;

  assign may_be_subnormal = a_sig_0[SigWidth-1] ? b_sig_0 : a_sig_0;
  assign mark = {1'b1, {FracWidth{1'b0}}} >> exp_0;

  leading_zero_counter #(
    .Width(SigWidth)
  ) u_left (
    .a_i(may_be_subnormal | mark),
    .count_o(left),
    .zero_o(unused_zero)
  );

  // ---- Cut behind the product

  logic [ProdWidth-1:0] product_1;
  logic [ExpWidth:0] exp_1;
  logic [LeftWidth-1:0] left_1;
  logic sign_1, exp_negative_1, nan_1, infinity_1, zero_1, invalid_1;

  delay_line #(
    .Width(ProdWidth),
    .Depth(32'(PipeRegs[0]))
  ) u_product (
    .clk_i,
    .enable_i(1'b1),
    .data_i(product),
    .data_o(product_1)
  );
  delay_line #(
    .Width(ExpWidth + LeftWidth + 7),
    .Depth(32'(PipeRegs[0]))
  ) u_sideband_product (
    .clk_i,
    .enable_i(1'b1),
    .data_i({exp_0, left, exp_negative_0, specials_0}),
    .data_o({exp_1, left_1, exp_negative_1, sign_1, nan_1, infinity_1, zero_1, invalid_1})
  );

  // ---- Shift: to the left, or by -exp = ~exp + 1 to the right, where exp is negative

  logic [ProdWidth-2:0] shifted;
  logic lost;
  logic [ProdWidth:0] placed;  // with a place for all that is lost to the right

  sticky_right_shift #(
    .Width(ProdWidth - 1),
    .AmountWidth(ExpWidth)
  ) u_right (
    .a_i(product_1[ProdWidth-1:1]),
    .amount_i(~exp_1[ExpWidth-1:0]),
    .shifted_o(shifted),
    .lost_o(lost)
  );
  assign placed = exp_negative_1 ? {1'b0, shifted, lost | product_1[0]}
                                 : {product_1 << left_1, 1'b0};

  // ---- Exponent after the shift to the left, beside it

  logic [ExpWidth:0] exp_less_left, left_extended;
  logic unused_carry;

  assign left_extended = (ExpWidth + 1)'(left_1);

  adder #(
    .Width(ExpWidth + 1),
    .Arith(Arith),
    .Adder(Adder)
  ) u_exp_less_left (
    .a_i(exp_1),
    .b_i(~left_extended),
    .carry_i(1'b1),
    .sum_o(exp_less_left),
    .carry_o(unused_carry)
  );

  // ---- Round

  logic [ExpWidth+FracWidth:0] result;
  fp_pkg::flags_t flags;

  fp_round #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .SubnormalShift(1'b0),
    .Arith(Arith)
  ) u_round (
    .sign_i(sign_1),
    .exponent_i({1'b0, exp_less_left & {(ExpWidth + 1){~exp_negative_1}}}),
    .significand_i({placed[ProdWidth-:FracWidth+4], |placed[ProdWidth-FracWidth-4:0]}),
    .nan_i(nan_1),
    .infinity_i(infinity_1),
    .zero_i(zero_1),
    .invalid_i(invalid_1),
    .divide_by_zero_i(1'b0),
    .rounding_mode_i,
    .tininess_after_i,
    .result_o(result),
    .flags_o(flags)
  );

  // ---- Last cut

  delay_line #(
    .Width(ExpWidth + FracWidth + 1),
    .Depth(32'(PipeRegs[1]))
  ) u_result (
    .clk_i,
    .enable_i(1'b1),
    .data_i(result),
    .data_o(result_o)
  );
  delay_line #(
    .Width($bits(flags)),
    .Depth(32'(PipeRegs[1]))
  ) u_flags (
    .clk_i,
    .enable_i(1'b1),
    .data_i(flags),
    .data_o(flags_o)
  );

endmodule
