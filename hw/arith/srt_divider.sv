// Divides significands: floor(2 * x / d * 4**Rows), and whether anything is left.
//
// Radix-4 SRT, all rows in one go: digits -2 .. 2, residual in carry-save form, so that no row
// waits for a carry but that of its seven-bit estimate. A first digit of 1 .. 4, taken from the
// operands themselves, brings the quotient's 2 x / d in (1, 4) to its place; Rows digits follow.
//
// dividend_i and divisor_i: normalised, one integer bit which must be 1 (else the outputs mean
// nothing). quotient_o: two integer bits and 2 * Rows fraction bits, exact and cut off.
//
// Combinational. Source: Ercegovac and Lang, "Division and Square Root", 1994, chapter 3; selection
// constants and why they hold in srt_pkg.
module srt_divider #(
  parameter int unsigned Width = 24,  // of both operands
  parameter int unsigned Rows  = 12,
  parameter int unsigned Adder = arith_pkg::AdderGraded
) (
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

  logic [ResWidth-1:0] dividend_doubled, divisor;

  if (PadWidth == 0) begin : gen_no_pad
    assign divisor = {1'b0, divisor_i};
    assign dividend_doubled = {dividend_i, 1'b0};
  end else begin : gen_pad
    assign divisor = {1'b0, divisor_i, {PadWidth{1'b0}}};
    assign dividend_doubled = {dividend_i, {(PadWidth + 1) {1'b0}}};
  end

  // ---- Where the digits begin for this divisor: known before the first row, the same for all

  localparam bit [8*8-1:0] MMinus1 = srt_pkg::thresholds(-1);
  localparam bit [8*8-1:0] M0 = srt_pkg::thresholds(0);
  localparam bit [8*8-1:0] M1 = srt_pkg::thresholds(1);
  localparam bit [8*8-1:0] M2 = srt_pkg::thresholds(2);
  localparam bit [8*16-1:0] First2 = srt_pkg::first_thresholds(2);
  localparam bit [8*16-1:0] First3 = srt_pkg::first_thresholds(3);
  localparam bit [8*16-1:0] First4 = srt_pkg::first_thresholds(4);

  logic [2:0] eighth;
  logic [3:0] sixteenth;
  logic [6:0] m_minus_1, m_0, m_1, m_2;

  assign eighth = divisor[FracWidth-1-:3];
  assign sixteenth = divisor[FracWidth-1-:4];
  assign m_minus_1 = MMinus1[{eighth, 3'b000} +: 7];
  assign m_0 = M0[{eighth, 3'b000} +: 7];
  assign m_1 = M1[{eighth, 3'b000} +: 7];
  assign m_2 = M2[{eighth, 3'b000} +: 7];

  // ---- First digit, 1 .. 4: w = 2 x - digit * d, in two parts, of which either can be nothing

  logic [5:0] first_estimate;
  logic from_2, from_3, from_4, subtract_1, subtract_2;
  logic [ResWidth-1:0] first_sum, first_carry;
  logic [1:0] first_digit;  // modulo 4

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
    .b_i(~(divisor & {ResWidth{subtract_1}})),
    .c_i(~(({ResWidth{subtract_2}} & (divisor << 1)) | ({ResWidth{from_4}} & (divisor << 2)))),
    .sum_o(first_sum),
    .carry_o(first_carry)
  );

  // ---- Rows: residuals and digits, the first one at the top of the words

  for (genvar r = 0; r <= Rows; r++) begin : gen_row
    logic [ResWidth-1:0] sum, carry;
    logic [1:0] positive, negative;

    if (r == 0) begin : gen_first
      assign sum = first_sum;
      assign carry = first_carry | ResWidth'(1);
      assign positive = first_digit;
      assign negative = 2'b00;
    end else begin : gen_next
      srt_row #(
        .Width(ResWidth),
        .Adder(Adder)
      ) u_row (
        .sum_i(gen_row[r-1].sum),
        .carry_i(gen_row[r-1].carry),
        .divisor_i(divisor),
        .m_minus_1_i(m_minus_1),
        .m_0_i(m_0),
        .m_1_i(m_1),
        .m_2_i(m_2),
        .sum_o(sum),
        .carry_o(carry),
        .positive_o(positive),
        .negative_o(negative)
      );
    end
  end

  logic [QuotientWidth-1:0] positives, negatives;
  for (genvar r = 0; r <= Rows; r++) begin : gen_digit
    assign positives[2*(Rows-r) +: 2] = gen_row[r].positive;
    assign negatives[2*(Rows-r) +: 2] = gen_row[r].negative;
  end

  // ---- Remainder: a negative one takes a unit off the quotient. (Then it is d - |w|, never zero.)

  logic [ResWidth-1:0] remainder;
  logic unused_remainder_carry;

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
  assign remainder_o = |remainder;

  // ---- Quotient: positive less negative digits, less that unit

  logic unused_quotient_carry;

  adder #(
    .Width(QuotientWidth),
    .Adder(Adder)
  ) u_quotient (
    .a_i(positives),
    .b_i(~negatives),
    .carry_i(~remainder[ResWidth-1]),
    .sum_o(quotient_o),
    .carry_o(unused_quotient_carry)
  );

endmodule
