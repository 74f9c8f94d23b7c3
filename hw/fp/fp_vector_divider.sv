// Floating-point divide of vectors by scalars: each dividend by the divisor that came before it.
//
// Words come one a clock: divisor_i says that word_i is the divisor of what follows, dividend_i that it is a component to
// divide; valid_o comes with the quotient. Latency: (FracWidth + 2) / 2 / RowsPerClock + 5 clocks, from dividend_i to valid_o.
// Throughput: Components dividends in Period clocks, and a divisor whenever no dividend comes. Components dividers take turns
// (srt_divider_iterative): of any Components + 1 dividends the last one comes at least Period clocks after the first. What is
// before and behind them is there once: unpacking, normalising, first digit, remainder, rounding.
//
// Correctly rounded in rounding_mode_i, which is the last stage's; all of IEEE 754 holds, as in
// fp_divider, but that no flags are raised. RowsPerClock: digits that a divider finds in a clock.
module fp_vector_divider #(
  parameter int unsigned ExpWidth = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith = arith_pkg::Graded,
  parameter int unsigned Components = 3,
  parameter int unsigned Period = 7,
  parameter int unsigned RowsPerClock = 2
) (
  input  logic                        clk_i,
  input  logic                        rst_ni,
  input  logic                        divisor_i,
  input  logic                        dividend_i,
  input  logic [ExpWidth+FracWidth:0] word_i,
  input  logic [2:0]                  rounding_mode_i,
  output logic                        valid_o,
  output logic [ExpWidth+FracWidth:0] result_o
);

  localparam int unsigned SigWidth = FracWidth + 1;  // significand with its integer bit
  localparam int unsigned PadWidth = (FracWidth < 5) ? 5 - FracWidth : 0;  // see srt_divider
  localparam int unsigned ResWidth = 2 + FracWidth + PadWidth;  // a divider's residual
  localparam int unsigned CountWidth = $clog2(SigWidth);
  localparam int unsigned RoundExpWidth = ExpWidth + 2;  // the rounder's exponent
  localparam int unsigned Rows = (FracWidth + 2) / 2;  // see fp_divider
  localparam int unsigned QuotientWidth = 2 * Rows + 2;
  localparam int unsigned RoundSigWidth = FracWidth + 5;  // of the rounder: to its sticky bit
  localparam int unsigned SideWidth = RoundExpWidth + 4;

  // ---- Unpack, normalise

  logic sign;
  logic [ExpWidth-1:0] exp;
  logic [SigWidth-1:0] sig, norm;
  logic [CountWidth-1:0] count;
  // verilator lint_off UNUSEDSIGNAL
  // No flags are raised.
  fp_pkg::class_t is, is_q, by_is_q;
  // verilator lint_on UNUSEDSIGNAL

  fp_unpack #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth)
  ) u_unpack (
    .packed_i(word_i),
    .sign_o(sign),
    .exponent_o(exp),
    .significand_o(sig),
    .class_o(is)
  );
  leading_zero_counter #(
    .Width(SigWidth)
  ) u_count (
    .a_i(sig),
    .count_o(count),
    .zero_o()
  );
  assign norm = sig << count;

  logic divisor_q, dividend_q, sign_q;
  logic [ExpWidth-1:0] exp_q;
  logic [SigWidth-1:0] norm_q;
  logic [CountWidth-1:0] count_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) {divisor_q, dividend_q} <= '0;
    else {divisor_q, dividend_q} <= {divisor_i, dividend_i};
  end
  always_ff @(posedge clk_i) begin
    {sign_q, is_q, exp_q, norm_q, count_q} <= {sign, is, exp, norm, count};
  end

  // ---- The divisor is kept, with what its exponent adds to a quotient's: the bias less that exponent, less one because
  // the quotient comes doubled, less one because the rounder wants it so

  localparam logic [RoundExpWidth-1:0] Offset = RoundExpWidth'(2 ** (ExpWidth - 1) - 3);
  logic [RoundExpWidth-1:0] count_wide, exp_less_count, offset_less_exp, exponent;

  assign count_wide = RoundExpWidth'(count_q);
  adder #(
    .Width(RoundExpWidth),
    .Arith(Arith)
  ) u_exp_less_count (
    .a_i({2'b00, exp_q}),
    .b_i(~count_wide),
    .carry_i(1'b1),
    .sum_o(exp_less_count),
    .carry_o()
  );
  adder #(
    .Width(RoundExpWidth),
    .Arith(Arith)
  ) u_offset_less_exp (
    .a_i(Offset),
    .b_i(~exp_less_count),
    .carry_i(1'b1),
    .sum_o(offset_less_exp),
    .carry_o()
  );

  logic by_sign_q;
  logic [SigWidth-1:0] by_norm_q;
  logic [RoundExpWidth-1:0] by_exponent_q;

  always_ff @(posedge clk_i) begin
    if (divisor_q) begin
      {by_sign_q, by_is_q, by_norm_q, by_exponent_q} <= {sign_q, is_q, norm_q, offset_less_exp};
    end
  end

  // ---- First digit, exponent and specials of a quotient

  logic [ResWidth-1:0] first_sum, first_carry, divisor;
  logic [1:0] first_digit;
  logic [SideWidth-1:0] side;

  assign divisor = ResWidth'(by_norm_q) << PadWidth;
  srt_first_row #(
    .Width(ResWidth)
  ) u_first_row (
    .dividend_doubled_i(ResWidth'(norm_q) << (PadWidth + 1)),
    .divisor_i(divisor),
    .sum_o(first_sum),
    .carry_o(first_carry),
    .digit_o(first_digit)
  );
  adder #(
    .Width(RoundExpWidth),
    .Arith(Arith)
  ) u_exponent (
    .a_i(exp_less_count),
    .b_i(by_exponent_q),
    .carry_i(1'b0),
    .sum_o(exponent),
    .carry_o()
  );
  assign side = {
    exponent,
    sign_q ^ by_sign_q,
    is_q.nan | by_is_q.nan | (is_q.zero & by_is_q.zero) | (is_q.infinity & by_is_q.infinity),
    is_q.infinity | by_is_q.zero,
    is_q.zero | by_is_q.infinity
  };

  // ---- Dividers in turn

  logic [Components-1:0] turn_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) turn_q <= Components'(1);
    else if (dividend_q) turn_q <= Components'({turn_q, turn_q[Components-1]});
  end

  localparam int unsigned DividedWidth = 2 * ResWidth + 2 * QuotientWidth + SideWidth;
  logic [Components-1:0] done;
  logic [DividedWidth-1:0] divided;  // the one that is done

  for (genvar k = 0; k < Components; k++) begin : gen_divider
    logic [DividedWidth-1:0] own, chosen;

    srt_divider_iterative #(
      .Width(ResWidth),
      .Rows(Rows),
      .RowsPerClock(RowsPerClock),
      .Period(Period),
      .SideWidth(SideWidth),
      .Arith(Arith)
    ) u_divider (
      .clk_i,
      .rst_ni,
      .start_i(dividend_q & turn_q[k]),
      .sum_i(first_sum),
      .carry_i(first_carry),
      .digit_i(first_digit),
      .divisor_i(divisor),
      .side_i(side),
      .done_o(done[k]),
      .sum_o(own[DividedWidth-1-:ResWidth]),
      .carry_o(own[DividedWidth-1-ResWidth-:ResWidth]),
      .positives_o(own[SideWidth+QuotientWidth+:QuotientWidth]),
      .negatives_o(own[SideWidth+:QuotientWidth]),
      .side_o(own[SideWidth-1:0])
    );
    if (k == 0) begin : gen_first
      assign chosen = own & {DividedWidth{done[k]}};
    end else begin : gen_next
      assign chosen = gen_divider[k-1].chosen | (own & {DividedWidth{done[k]}});
    end
  end
  assign divided = gen_divider[Components-1].chosen;

  // ---- Quotient

  logic [QuotientWidth-1:0] quotient;
  logic remainder, result_sign, result_nan, result_infinity, result_zero;
  logic [RoundExpWidth-1:0] result_exponent;

  srt_quotient #(
    .Width(ResWidth),
    .Digits(Rows + 1),
    .SideWidth(SideWidth),
    .Arith(Arith),
    .Pipelined(1'b1)
  ) u_quotient (
    .clk_i,
    .valid_i(|done),
    .sum_i(divided[DividedWidth-1-:ResWidth]),
    .carry_i(divided[DividedWidth-1-ResWidth-:ResWidth]),
    .positives_i(divided[SideWidth+QuotientWidth+:QuotientWidth]),
    .negatives_i(divided[SideWidth+:QuotientWidth]),
    .side_i(divided[SideWidth-1:0]),
    .quotient_o(quotient),
    .remainder_o(remainder),
    .side_o({result_exponent, result_sign, result_nan, result_infinity, result_zero}),
    .valid_o()
  );

  // ---- Round

  logic [ExpWidth+FracWidth:0] result;
  logic [2:0] valid_q;

  fp_round #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .Arith(Arith)
  ) u_round (
    .sign_i(result_sign),
    .exponent_i(result_exponent),
    .significand_i({quotient, {(RoundSigWidth - QuotientWidth - 1) {1'b0}}, remainder}),
    .special_i({result_nan, result_infinity, result_zero, 2'b00}),
    .rounding_mode_i,
    .tininess_after_i(1'b0),
    .result_o(result),
    .flags_o()
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= '0;
    else valid_q <= {valid_q[1:0], |done};
  end
  always_ff @(posedge clk_i) result_o <= result;
  assign valid_o = valid_q[2];

endmodule
