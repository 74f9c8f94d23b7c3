// Divides significands by radix-4 SRT: floor(2 * x / d * 4**Rows), and whether there is a remainder.
//
// x is dividend_i and d is divisor_i; both are normalised, with one integer bit that must be 1, else the outputs are
// invalid. The quotient 2 x / d is in (1, 4). Its first digit, 1 .. 4, comes from srt_first_row. Each of the next Rows
// digits, -2 .. 2, comes from a srt_row. Residuals are in carry-save form, so carries propagate only in a row's
// seven-bit estimate of the residual. quotient_o: two integer bits and 2 * Rows fraction bits, truncated. side_i is
// user data; side_o is the side_i of the same division.
//
// Pipelined: registers after the first digit, each row, remainder and quotient. Latency: 0 or, Pipelined, Rows + 3
// clocks. Throughput: one division a clock. valid_o is valid_i after the latency. While valid_o is low, the outputs of
// a pipelined divider are invalid, as registers load valid data only. Nothing is reset: valid_o is undefined at first.
// Source: Ercegovac and Lang, "Division and Square Root", 1994, chapter 3; selection constants: srt_pkg.
module srt_divider #(
  parameter int unsigned Width = 24,  // width of both operands
  parameter int unsigned Rows  = 12,
  parameter int unsigned SideWidth = 1,
  parameter int unsigned Arith = arith_pkg::Graded,
  parameter bit          Pipelined = 1'b0
) (
  input  logic                 clk_i,
  input  logic                 valid_i,
  input  logic [Width-1:0]     dividend_i,
  input  logic [Width-1:0]     divisor_i,
  input  logic [SideWidth-1:0] side_i,
  output logic [2*Rows+1:0]    quotient_o,
  output logic                 remainder_o,
  output logic [SideWidth-1:0] side_o,
  output logic                 valid_o
);

  // Fraction bits of the residual: as many as the divisor has, but not fewer than digit selection reads.
  localparam int unsigned FracWidth = (Width < 6) ? 5 : Width - 1;
  localparam int unsigned ResWidth = 2 + FracWidth;
  localparam int unsigned PadWidth = FracWidth + 1 - Width;

  if (!srt_pkg::sound() || !srt_pkg::first_sound()) begin : gen_check
    $error("srt_divider: expected selection constants that overlap");
  end

  // ---- Rows: residuals, and the digits so far, the first digit at the top of the words

  for (genvar r = 0; r <= Rows; r++) begin : gen_row
    localparam int unsigned DigitsWidth = 2 * (r + 1);
    logic [ResWidth-1:0] divisor, next_sum, next_carry, sum_q, carry_q, divisor_q;
    logic [DigitsWidth-1:0] positives, negatives, positives_q, negatives_q;
    logic [1:0] positive, negative;  // the row's digit is positive - negative
    logic [SideWidth-1:0] side, side_q;
    logic valid, valid_q;

    if (r == 0) begin : gen_first
      assign divisor = ResWidth'(divisor_i) << PadWidth;
      assign positives = positive;
      assign negatives = negative;
      assign negative = 2'b00;
      assign side = side_i;
      assign valid = valid_i;
      srt_first_row #(
        .Width(ResWidth)
      ) u_row (
        .dividend_doubled_i(ResWidth'(dividend_i) << (PadWidth + 1)),
        .divisor_i(divisor),
        .sum_o(next_sum),
        .carry_o(next_carry),
        .digit_o(positive)
      );
    end else begin : gen_next
      assign divisor = gen_row[r-1].divisor_q;
      assign positives = {gen_row[r-1].positives_q, positive};
      assign negatives = {gen_row[r-1].negatives_q, negative};
      assign side = gen_row[r-1].side_q;
      assign valid = gen_row[r-1].valid_q;
      srt_row #(
        .Width(ResWidth),
        .Arith(Arith)
      ) u_row (
        .sum_i(gen_row[r-1].sum_q),
        .carry_i(gen_row[r-1].carry_q),
        .divisor_i(divisor),
        .sum_o(next_sum),
        .carry_o(next_carry),
        .positive_o(positive),
        .negative_o(negative)
      );
    end

    delay_line #(
      .Width(1),
      .Depth(32'(Pipelined))
    ) u_valid (
      .clk_i,
      .enable_i(1'b1),
      .data_i(valid),
      .data_o(valid_q)
    );
    delay_line #(
      .Width(3 * ResWidth + 2 * DigitsWidth + SideWidth),
      .Depth(32'(Pipelined))
    ) u_cut_row (
      .clk_i,
      .enable_i(valid),
      .data_i({next_sum, next_carry, divisor, positives, negatives, side}),
      .data_o({sum_q, carry_q, divisor_q, positives_q, negatives_q, side_q})
    );
  end

  // ---- Remainder: the last residual w or, if w is negative, d + w > 0; the quotient is then one unit smaller

  localparam int unsigned QuotientWidth = 2 * Rows + 2;
  logic [ResWidth-1:0] remainder, unused_divisor;
  logic [QuotientWidth-1:0] plus, minus, quotient;
  logic [SideWidth-1:0] remainder_side;
  logic remainder_negative, remainder_left, remainder_valid;

  adder #(
    .Width(ResWidth),
    .Arith(Arith)
  ) u_remainder (
    .a_i(gen_row[Rows].sum_q),
    .b_i(gen_row[Rows].carry_q),
    .carry_i(1'b0),
    .sum_o(remainder),
    .carry_o()
  );
  assign unused_divisor = gen_row[Rows].divisor_q;

  delay_line #(
    .Width(1),
    .Depth(32'(Pipelined))
  ) u_valid_remainder (
    .clk_i,
    .enable_i(1'b1),
    .data_i(gen_row[Rows].valid_q),
    .data_o(remainder_valid)
  );
  delay_line #(
    .Width(2 * QuotientWidth + SideWidth + 2),
    .Depth(32'(Pipelined))
  ) u_cut_remainder (
    .clk_i,
    .enable_i(gen_row[Rows].valid_q),
    .data_i({gen_row[Rows].positives_q, gen_row[Rows].negatives_q, gen_row[Rows].side_q,
             remainder[ResWidth-1], |remainder}),
    .data_o({plus, minus, remainder_side, remainder_negative, remainder_left})
  );

  // ---- Quotient: positive minus negative digits, minus one unit if the remainder is negative

  adder #(
    .Width(QuotientWidth),
    .Arith(Arith)
  ) u_quotient (
    .a_i(plus),
    .b_i(~minus),
    .carry_i(~remainder_negative),
    .sum_o(quotient),
    .carry_o()
  );
  delay_line #(
    .Width(1),
    .Depth(32'(Pipelined))
  ) u_valid_quotient (
    .clk_i,
    .enable_i(1'b1),
    .data_i(remainder_valid),
    .data_o(valid_o)
  );
  delay_line #(
    .Width(QuotientWidth + SideWidth + 1),
    .Depth(32'(Pipelined))
  ) u_cut_quotient (
    .clk_i,
    .enable_i(remainder_valid),
    .data_i({quotient, remainder_left, remainder_side}),
    .data_o({quotient_o, remainder_o, side_o})
  );

endmodule
