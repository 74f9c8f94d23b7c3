// Floating-point multiply: a_i * b_i.
//
// Significands are multiplied without normalising: a subnormal one has leading zeros. In parallel, the product's shift
// is computed from the operands: left by the leading zeros, as long as the exponent does not fall below the smallest
// one; right if the exponent is below the smallest one from the start. Then the product is shifted and rounded.
//
// Arith: see arith_pkg. ConstantRow: 1 for the paper's carry-save tree, see booth_multiplier.
// Pipelined: registers before the product, after it, and after the result. Latency: 0 or, Pipelined, 3 clocks.
// Throughput: one operation a clock. The last stage uses rounding_mode_i: keep it while operations are in flight.
//
// Takes every bit pattern. Correctly rounded. The sign, of zeros and infinities too, is the exclusive OR of the
// operands' signs. Zero times infinity is invalid.
// Source: IEEE 754-2019, clause 5.4.1; the paper's multiplier, section 3.4.
module fp_multiplier #(
  parameter int unsigned ExpWidth    = 8,
  parameter int unsigned FracWidth   = 23,
  parameter int unsigned Arith       = arith_pkg::Graded,
  parameter bit          ConstantRow = 1'b0,
  parameter bit          Pipelined   = 1'b0
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
  fp_pkg::class_t a_class, b_class;

  fp_unpack #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth)
  ) u_unpack (
    .packed_i({b_i, a_i}),
    .sign_o({b_sign, a_sign}),
    .exponent_o({b_exp, a_exp}),
    .significand_o({b_sig, a_sig}),
    .class_o({b_class, a_class})
  );

  // ---- Add the exponents: fp_round expects the product's biased exponent less one, a_exp + b_exp - bias - 1 = a_exp +
  // b_exp - 2**(ExpWidth-1). Subtracting 2**(ExpWidth-1) changes only the top two bits.

  logic [ExpWidth:0] exp_sum, exp;
  logic exp_negative;

  adder #(
    .Width(ExpWidth + 1),
    .Arith(Arith)
  ) u_exp_sum (
    .a_i({1'b0, a_exp}),
    .b_i({1'b0, b_exp}),
    .carry_i(1'b0),
    .sum_o(exp_sum),
    .carry_o()
  );
  assign exp_negative = exp_sum[ExpWidth:ExpWidth-1] == 2'b00;
  assign exp = exp_sum ^ {~exp_sum[ExpWidth-1], 1'b1, {(ExpWidth - 1) {1'b0}}};

  // ---- Special results

  fp_pkg::special_t special;

  always_comb begin
    special = '0;
    if (a_class.special | b_class.special) begin
      special.invalid = a_class.signaling_nan | b_class.signaling_nan
                      | (a_class.infinity & b_class.zero) | (a_class.zero & b_class.infinity);
      special.nan = a_class.nan | b_class.nan | special.invalid;
      special.infinity = a_class.infinity | b_class.infinity;
      special.zero = a_class.zero | b_class.zero;
    end
  end

  // ---- First register: before the product

  logic [SigWidth-1:0] a_sig_0, b_sig_0;
  logic [ExpWidth:0] exp_0;
  logic exp_negative_0, sign_0;
  fp_pkg::special_t special_0;

  delay_line #(
    .Width(2 * SigWidth + ExpWidth + 3 + $bits(special)),
    .Depth(32'(Pipelined))
  ) u_operands (
    .clk_i,
    .enable_i(1'b1),
    .data_i({a_sig, b_sig, exp, exp_negative, a_sign ^ b_sign, special}),
    .data_o({a_sig_0, b_sig_0, exp_0, exp_negative_0, sign_0, special_0})
  );

  // ---- Multiply the significands: in [1, 4) if both are normal

  logic [ProdWidth-1:0] product;

  multiplier #(
    .Width(SigWidth),
    .Arith(Arith),
    .ConstantRow(ConstantRow)
  ) u_multiplier (
    .a_i(a_sig_0),
    .b_i(b_sig_0),
    .product_o(product)
  );

  // ---- Left shift: the leading zeros of the subnormal operand, if there is one (the product of two subnormals is far
  // below the smallest subnormal). `mark` stops the count of zeros where the exponent becomes the smallest one.

  logic [SigWidth-1:0] may_be_subnormal, mark;
  logic [LeftWidth-1:0] left;

  assign may_be_subnormal = a_sig_0[SigWidth-1] ? b_sig_0 : a_sig_0;
  assign mark = {1'b1, {FracWidth{1'b0}}} >> exp_0;

  leading_zero_counter #(
    .Width(SigWidth)
  ) u_left (
    .a_i(may_be_subnormal | mark),
    .count_o(left),
    .zero_o()
  );

  // ---- Second register: after the product

  logic [ProdWidth-1:0] product_1;
  logic [ExpWidth:0] exp_1;
  logic [LeftWidth-1:0] left_1;
  logic sign_1, exp_negative_1;
  fp_pkg::special_t special_1;

  delay_line #(
    .Width(ProdWidth),
    .Depth(32'(Pipelined))
  ) u_product (
    .clk_i,
    .enable_i(1'b1),
    .data_i(product),
    .data_o(product_1)
  );
  delay_line #(
    .Width(ExpWidth + LeftWidth + 3 + $bits(special)),
    .Depth(32'(Pipelined))
  ) u_sideband_product (
    .clk_i,
    .enable_i(1'b1),
    .data_i({exp_0, left, exp_negative_0, sign_0, special_0}),
    .data_o({exp_1, left_1, exp_negative_1, sign_1, special_1})
  );

  // ---- Shift: to the left or, if exp is negative, by -exp = ~exp + 1 to the right

  logic [ProdWidth-2:0] shifted;
  logic lost;
  logic [ProdWidth:0] placed;  // lowest bit: a 1 was shifted out to the right

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

  // ---- Exponent after the shift to the left, in parallel with it

  logic [ExpWidth:0] exp_less_left, left_extended;

  assign left_extended = (ExpWidth + 1)'(left_1);

  adder #(
    .Width(ExpWidth + 1),
    .Arith(Arith)
  ) u_exp_less_left (
    .a_i(exp_1),
    .b_i(~left_extended),
    .carry_i(1'b1),
    .sum_o(exp_less_left),
    .carry_o()
  );

  // ---- Round

  logic [ExpWidth+FracWidth:0] result;
  fp_pkg::flags_t flags;

  fp_round #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .SubnormalShift(1'b0)
  ) u_round (
    .sign_i(sign_1),
    .exponent_i({1'b0, exp_less_left & {(ExpWidth + 1){~exp_negative_1}}}),
    .significand_i({placed[ProdWidth-:FracWidth+4], |placed[ProdWidth-FracWidth-4:0]}),
    .special_i(special_1),
    .rounding_mode_i,
    .tininess_after_i,
    .result_o(result),
    .flags_o(flags)
  );

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
