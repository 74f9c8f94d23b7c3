// Floating-point divide: a_i / b_i.
//
// Steps: unpack, normalise subnormals, divide the significands digit by digit (srt_divider), round.
//
// QuotientBits = 0 rounds correctly (IEEE 754). Other values truncate the quotient to that many significant bits, the
// leading one included. (21 gives the quotients printed in the paper's worked example, up to 5 ulp low in binary32.) A
// truncated quotient is rounded only if the result is subnormal. The truncation itself raises no flag.
//
// Pipelined: registers after normalising, after each of the Rows + 3 stages of srt_divider (a row gives two bits of the
// quotient; binary32 has 12 rows) and after the result. Latency: 0 or, Pipelined, Rows + 5 clocks. Throughput: one
// division a clock. Registers load only what comes with valid_i; in other clocks the outputs of a pipelined divider are
// invalid. The last stage uses rounding_mode_i, so it must not change while divisions are in flight.
//
// A non-zero finite number divided by zero is infinity and raises divide_by_zero; 0/0 and inf/inf are invalid.
// Source: IEEE 754-2019, clauses 5.4.1 and 7; Choi and Chung, Trans. KIEE 48A-5-21, section 4.2.
module fp_divider #(
  parameter int unsigned ExpWidth     = 8,
  parameter int unsigned FracWidth    = 23,
  parameter int unsigned Arith        = arith_pkg::Graded,
  parameter int unsigned QuotientBits = 0,
  parameter bit          Pipelined    = 1'b0
) (
  input  logic                        clk_i,
  input  logic                        valid_i,
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  logic [2:0]                  rounding_mode_i,
  input  logic                        tininess_after_i,
  output logic [ExpWidth+FracWidth:0] result_o,
  output fp_pkg::flags_t              flags_o
);

  localparam int unsigned SigWidth = FracWidth + 1;  // significand with its integer bit
  localparam int unsigned CountWidth = $clog2(FracWidth + 1);
  localparam int unsigned RoundExpWidth = ExpWidth + 2;  // exponent_i of fp_round
  // Fraction bits of the doubled quotient, which is in (1, 4); a row gives two. A quotient below 2 needs most: the bits
  // of the significand's fraction and a guard bit or, with QuotientBits, all kept bits but the leading one.
  localparam int unsigned QuotientFrac = (QuotientBits == 0) ? FracWidth + 1 : QuotientBits - 1;
  localparam int unsigned Rows = (QuotientFrac + 1) / 2;
  localparam int unsigned QuotientWidth = 2 * Rows + 2;
  localparam int unsigned RoundSigWidth = FracWidth + 5;  // significand_i of fp_round

  if (QuotientBits > FracWidth + 1 || Rows > 27) begin : gen_check
    $error("fp_divider: expected at most FracWidth + 1 QuotientBits and 27 rows");
  end

  // ---- Unpack; [0] is a's, [1] is b's

  logic [1:0] sign;
  logic [1:0][ExpWidth-1:0] exp;
  logic [1:0][SigWidth-1:0] sig, norm, norm_1;
  logic [1:0][CountWidth-1:0] count;
  fp_pkg::class_t a_class, b_class;

  fp_unpack #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth)
  ) u_unpack (
    .packed_i({b_i, a_i}),
    .sign_o(sign),
    .exponent_o(exp),
    .significand_o(sig),
    .class_o({b_class, a_class})
  );

  // ---- Normalise

  for (genvar n = 0; n < 2; n++) begin : gen_normalise
    leading_zero_counter #(
      .Width(SigWidth)
    ) u_count (
      .a_i(sig[n]),
      .count_o(count[n]),
      .zero_o()
    );
    assign norm[n] = sig[n] << count[n];
  end

  // ---- Exponent for fp_round: (a_exp - a_count) - (b_exp - b_count) + bias - 2. The -2: one because the quotient is
  // doubled, one because fp_round expects the exponent less one

  localparam logic [RoundExpWidth-1:0] Offset = RoundExpWidth'(2 ** (ExpWidth - 1) - 3);
  logic [RoundExpWidth-1:0] a_exp_offset, exp_difference, count_difference;
  logic [RoundExpWidth-1:0] a_count_wide;

  assign a_count_wide = RoundExpWidth'(count[0]);
  adder #(
    .Width(RoundExpWidth),
    .Arith(Arith)
  ) u_offset (
    .a_i({2'b00, exp[0]}),
    .b_i(Offset),
    .carry_i(1'b0),
    .sum_o(a_exp_offset),
    .carry_o()
  );
  adder #(
    .Width(RoundExpWidth),
    .Arith(Arith)
  ) u_exp_difference (
    .a_i(a_exp_offset),
    .b_i(~{2'b00, exp[1]}),
    .carry_i(1'b1),
    .sum_o(exp_difference),
    .carry_o()
  );
  adder #(
    .Width(RoundExpWidth),
    .Arith(Arith)
  ) u_count_difference (
    .a_i(RoundExpWidth'(count[1])),
    .b_i(~a_count_wide),
    .carry_i(1'b1),
    .sum_o(count_difference),
    .carry_o()
  );

  // ---- Special results

  fp_pkg::special_t special;

  always_comb begin
    special = '0;
    if (a_class.special | b_class.special) begin
      special.invalid = a_class.signaling_nan | b_class.signaling_nan
                      | (a_class.zero & b_class.zero) | (a_class.infinity & b_class.infinity);
      special.nan = a_class.nan | b_class.nan | special.invalid;
      special.infinity = a_class.infinity | b_class.zero;
      special.zero = a_class.zero | b_class.infinity;
      special.divide_by_zero = b_class.zero & ~a_class.zero & ~a_class.infinity & ~a_class.nan;
    end
  end

  // ---- First register; exponent, sign and specials pass beside the division

  logic [RoundExpWidth-1:0] exp_difference_1, count_difference_1, exponent, exponent_2;
  logic sign_1, sign_2, valid_1, divided;
  fp_pkg::special_t special_1, special_2;

  delay_line #(
    .Width(1),
    .Depth(32'(Pipelined))
  ) u_valid (
    .clk_i,
    .enable_i(1'b1),
    .data_i(valid_i),
    .data_o(valid_1)
  );
  delay_line #(
    .Width(2 * SigWidth + 2 * RoundExpWidth + 1 + $bits(special)),
    .Depth(32'(Pipelined))
  ) u_normalised (
    .clk_i,
    .enable_i(valid_i),
    .data_i({norm, exp_difference, count_difference, ^sign, special}),
    .data_o({norm_1, exp_difference_1, count_difference_1, sign_1, special_1})
  );

  adder #(
    .Width(RoundExpWidth),
    .Arith(Arith)
  ) u_exponent (
    .a_i(exp_difference_1),
    .b_i(count_difference_1),
    .carry_i(1'b0),
    .sum_o(exponent),
    .carry_o()
  );

  // ---- Divide: the doubled quotient, in (1, 4)

  logic [QuotientWidth-1:0] quotient;
  logic remainder;

  srt_divider #(
    .Width(SigWidth),
    .Rows(Rows),
    .SideWidth(RoundExpWidth + 1 + $bits(special)),
    .Arith(Arith),
    .Pipelined(Pipelined)
  ) u_divide (
    .clk_i,
    .valid_i(valid_1),
    .dividend_i(norm_1[0]),
    .divisor_i(norm_1[1]),
    .side_i({exponent, sign_1, special_1}),
    .quotient_o(quotient),
    .remainder_o(remainder),
    .side_o({exponent_2, sign_2, special_2}),
    .valid_o(divided)
  );

  // ---- Align the quotient for fp_round. With QuotientBits, keep that many bits, from the leading one downwards

  logic [RoundSigWidth-1:0] significand;

  if (QuotientBits == 0) begin : gen_ieee
    assign significand = {quotient, {(RoundSigWidth - QuotientWidth - 1) {1'b0}}, remainder};
  end else begin : gen_cut_off
    localparam logic [QuotientWidth-1:0] KeepFrom2 = {
      {QuotientBits{1'b1}}, {(QuotientWidth - QuotientBits) {1'b0}}
    };
    localparam logic [QuotientWidth-1:0] KeepFrom1 = {
      {(QuotientBits + 1) {1'b1}}, {(QuotientWidth - 1 - QuotientBits) {1'b0}}
    };
    logic unused_remainder;
    assign unused_remainder = remainder;
    assign significand = {quotient & (quotient[QuotientWidth-1] ? KeepFrom2 : KeepFrom1),
                          {(RoundSigWidth - QuotientWidth) {1'b0}}};
  end

  // ---- Rounding

  logic [ExpWidth+FracWidth:0] result;
  fp_pkg::flags_t flags;

  fp_round #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth)
  ) u_round (
    .sign_i(sign_2),
    .exponent_i(exponent_2),
    .significand_i(significand),
    .special_i(special_2),
    .rounding_mode_i,
    .tininess_after_i,
    .result_o(result),
    .flags_o(flags)
  );

  // ---- Last register

  delay_line #(
    .Width(ExpWidth + FracWidth + 6),
    .Depth(32'(Pipelined))
  ) u_result (
    .clk_i,
    .enable_i(divided),
    .data_i({result, flags}),
    .data_o({result_o, flags_o})
  );

endmodule
