// Divides significands: floor(2 * x / d * 4**Rows), and whether anything is left.
//
// Radix-4 SRT, a row for each digit: digits -2 .. 2, residual in carry-save form, so that no row waits
// for a carry but that of its seven-bit estimate. A first digit of 1 .. 4, taken from the operands
// themselves, brings the quotient's 2 x / d in (1, 4) to its place; Rows digits follow.
//
// dividend_i and divisor_i: normalised, one integer bit which must be 1 (else the outputs mean
// nothing). quotient_o: two integer bits and 2 * Rows fraction bits, exact and cut off.
//
// Pipelined = 0: combinational, all rows in one go. Pipelined = 1: registers behind the first digit,
// every row, the remainder and the quotient, a division a clock, latency Rows + 3; clocks without
// enable_i don't count.
// Source: Ercegovac and Lang, "Division and Square Root", 1994, chapter 3; selection
// constants and why they hold in srt_pkg.
module srt_divider_stages #(
  parameter int unsigned Width = 24,  // of both operands
  parameter int unsigned Rows  = 12,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  parameter bit          Pipelined = 1'b0
) (
  input  logic                clk_i,
  input  logic                enable_i,
  input  logic [Width-1:0]    dividend_i,
  input  logic [Width-1:0]    divisor_i,
  output logic [2*Rows+1:0]   quotient_o,
  output logic                remainder_o
);

  // Fraction bits of the residual: the divisor's, and no fewer than the selection looks at.
  localparam int unsigned FracWidth = (Width < 6) ? 5 : Width - 1;
  localparam int unsigned ResWidth = 2 + FracWidth;
  localparam int unsigned QuotientWidth = 2 + 2 * Rows;
  localparam int unsigned PadWidth = ResWidth - 1 - Width;  // one integer bit on top

  if (!srt_pkg::sound() || !srt_pkg::first_sound()) begin : gen_check
    $error("srt_divider: selection constants without overlap");
  end

  logic [ResWidth-1:0] dividend_doubled, padded_divisor;

  if (PadWidth == 0) begin : gen_no_pad
    assign padded_divisor = {1'b0, divisor_i};
    assign dividend_doubled = {dividend_i, 1'b0};
  end else begin : gen_pad
    assign padded_divisor = {1'b0, divisor_i, {PadWidth{1'b0}}};
    assign dividend_doubled = {dividend_i, {(PadWidth + 1) {1'b0}}};
  end

  // ---- First digit, 1 .. 4: w = 2 x - digit * d, the digit being 2 or 4 or nothing, and 1 or nothing

  localparam bit [8*16-1:0] First2 = srt_pkg::first_thresholds(2);
  localparam bit [8*16-1:0] First3 = srt_pkg::first_thresholds(3);
  localparam bit [8*16-1:0] First4 = srt_pkg::first_thresholds(4);

  logic [3:0] sixteenth;
  logic [5:0] first_estimate;
  logic from_2, from_3, from_4, subtract_1, subtract_2;
  logic [ResWidth-1:0] first_sum, first_carry;
  logic [1:0] first_digit;  // modulo 4

  assign sixteenth = padded_divisor[FracWidth-1-:4];
  assign first_estimate = {1'b0, dividend_doubled[ResWidth-1-:5]};
  assign from_2 = first_estimate >= First2[{sixteenth, 3'b000} +: 6];
  assign from_3 = first_estimate >= First3[{sixteenth, 3'b000} +: 6];
  assign from_4 = first_estimate >= First4[{sixteenth, 3'b000} +: 6];
  assign subtract_1 = ~from_2 | (from_3 & ~from_4);
  assign subtract_2 = from_2 & ~from_4;
  assign first_digit = {subtract_2, subtract_1};

  carry_save_adder #(
    .Width(ResWidth)
  ) u_first (
    .a_i(dividend_doubled | ResWidth'(1)),  // a one for each complement, in two free last places
    .b_i(~(padded_divisor & {ResWidth{subtract_1}})),
    .c_i(~(({ResWidth{subtract_2}} & (padded_divisor << 1))
         | ({ResWidth{from_4}} & (padded_divisor << 2)))),
    .sum_o(first_sum),
    .carry_o(first_carry)
  );

  localparam bit [8*8-1:0] MMinus1 = srt_pkg::thresholds(-1);
  localparam bit [8*8-1:0] M0 = srt_pkg::thresholds(0);
  localparam bit [8*8-1:0] M1 = srt_pkg::thresholds(1);
  localparam bit [8*8-1:0] M2 = srt_pkg::thresholds(2);

  // ---- Rows: residuals, and the digits so far, the first one at the top of the words

  for (genvar r = 0; r <= Rows; r++) begin : gen_row
    localparam int unsigned DigitsWidth = 2 * (r + 1);
    logic [ResWidth-1:0] sum_d, carry_d, divisor_d, sum, carry, divisor;
    logic [DigitsWidth-1:0] positives_d, negatives_d, positives, negatives;

    if (r == 0) begin : gen_first
      assign sum_d = first_sum;
      assign carry_d = first_carry | ResWidth'(1);
      assign divisor_d = padded_divisor;
      assign positives_d = first_digit;
      assign negatives_d = 2'b00;
    end else begin : gen_next
      logic [1:0] positive, negative;
      logic [2:0] eighth;  // of the divisor: says where the digits begin, see srt_pkg

      assign eighth = gen_row[r-1].divisor[FracWidth-1-:3];
      srt_row #(
        .Width(ResWidth),
        .Adder(Adder)
      ) u_row (
        .sum_i(gen_row[r-1].sum),
        .carry_i(gen_row[r-1].carry),
        .divisor_i(gen_row[r-1].divisor),
        .m_minus_1_i(MMinus1[{eighth, 3'b000} +: 7]),
        .m_0_i(M0[{eighth, 3'b000} +: 7]),
        .m_1_i(M1[{eighth, 3'b000} +: 7]),
        .m_2_i(M2[{eighth, 3'b000} +: 7]),
        .sum_o(sum_d),
        .carry_o(carry_d),
        .positive_o(positive),
        .negative_o(negative)
      );
      assign divisor_d = gen_row[r-1].divisor;
      assign positives_d = {gen_row[r-1].positives, positive};
      assign negatives_d = {gen_row[r-1].negatives, negative};
    end

    if (Pipelined) begin : gen_registers
      always_ff @(posedge clk_i) begin
        if (enable_i) begin
          {sum, carry, divisor, positives, negatives} <= {
            sum_d, carry_d, divisor_d, positives_d, negatives_d
          };
        end
      end
    end else begin : gen_wires
      assign {sum, carry, divisor, positives, negatives} = {
        sum_d, carry_d, divisor_d, positives_d, negatives_d
      };
    end
  end

  // ---- Remainder: a negative one takes a unit off the quotient. (Then it is d - |w|, never zero.)

  logic [ResWidth-1:0] remainder;
  logic [QuotientWidth-1:0] positives, negatives;
  logic remainder_negative, remainder_left, unused_remainder_carry;
  logic [ResWidth-1:0] unused_divisor;

  assign unused_divisor = gen_row[Rows].divisor;

  adder #(
    .Width(ResWidth),
    .Adder(Adder)
  ) u_remainder (
    .a_i(gen_row[Rows].sum),
    .b_i(gen_row[Rows].carry),
    .carry_i(1'b0),
    .sum_o(remainder),
    .carry_o(unused_remainder_carry)
  );
  delay_line #(
    .Width(2),
    .Depth(32'(Pipelined))
  ) u_remainder_stage (
    .clk_i,
    .enable_i,
    .data_i({remainder[ResWidth-1], |remainder}),
    .data_o({remainder_negative, remainder_left})
  );
  delay_line #(
    .Width(QuotientWidth),
    .Depth(32'(Pipelined))
  ) u_positives_stage (
    .clk_i,
    .enable_i,
    .data_i(gen_row[Rows].positives),
    .data_o(positives)
  );
  delay_line #(
    .Width(QuotientWidth),
    .Depth(32'(Pipelined))
  ) u_negatives_stage (
    .clk_i,
    .enable_i,
    .data_i(gen_row[Rows].negatives),
    .data_o(negatives)
  );

  // ---- Quotient: positive less negative digits, less that unit

  logic [QuotientWidth-1:0] quotient;
  logic unused_quotient_carry;

  adder #(
    .Width(QuotientWidth),
    .Adder(Adder)
  ) u_quotient (
    .a_i(positives),
    .b_i(~negatives),
    .carry_i(~remainder_negative),
    .sum_o(quotient),
    .carry_o(unused_quotient_carry)
  );
  delay_line #(
    .Width(QuotientWidth + 1),
    .Depth(32'(Pipelined))
  ) u_quotient_stage (
    .clk_i,
    .enable_i,
    .data_i({quotient, remainder_left}),
    .data_o({quotient_o, remainder_o})
  );

endmodule
