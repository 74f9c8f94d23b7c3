// Divides significands: floor(2 * x / d * 4**Rows), and whether anything is left.
//
// Radix-4 SRT, a row for each digit: digits -2 .. 2, residual in carry-save form, so that no row waits
// for a carry but that of its seven-bit estimate. A first digit of 1 .. 4, taken from the operands
// themselves, brings the quotient's 2 x / d in (1, 4) to its place; Rows digits follow.
//
// dividend_i and divisor_i: normalised, one integer bit which must be 1 (else the outputs mean
// nothing). quotient_o: two integer bits and 2 * Rows fraction bits, exact and cut off. beside_i goes
// along and comes out with its quotient.
//
// Pipelined = 0: combinational, all rows in one go. Pipelined = 1: registers behind the first digit,
// every row, the remainder and the quotient, a division a clock, latency Rows + 3; clocks without
// enable_i don't count. Only what is valid moves: valid_o is valid_i, as much later, and while it is
// low the outputs mean nothing. Nothing is reset, so that valid_o means nothing at first.
// Source: Ercegovac and Lang, "Division and Square Root", 1994, chapter 3; selection
// constants and why they hold in srt_pkg.
module srt_divider_stages #(
  parameter int unsigned Width = 24,  // of both operands
  parameter int unsigned Rows  = 12,
  parameter int unsigned BesideWidth = 1,
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  parameter bit          Pipelined = 1'b0
) (
  input  logic                clk_i,
  input  logic                enable_i,
  input  logic                valid_i,
  input  logic [Width-1:0]    dividend_i,
  input  logic [Width-1:0]    divisor_i,
  input  logic [BesideWidth-1:0] beside_i,
  output logic [2*Rows+1:0]   quotient_o,
  output logic                remainder_o,
  output logic [BesideWidth-1:0] beside_o,
  output logic                valid_o
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

  // ---- First digit, 1 .. 4: w = 2 x - digit * d, the digit being 2 or 4 or nothing, and 1 or nothing.
  // The digit is given modulo 4; a one for each complement goes to two free last places

  localparam bit [8*16-1:0] First2 = srt_pkg::first_thresholds(2);
  localparam bit [8*16-1:0] First3 = srt_pkg::first_thresholds(3);
  localparam bit [8*16-1:0] First4 = srt_pkg::first_thresholds(4);

  task automatic divide_first(input logic [ResWidth-1:0] x_doubled, input logic [ResWidth-1:0] d,
                              output logic [ResWidth-1:0] sum, output logic [ResWidth-1:0] carry,
                              output logic [1:0] digit);
    logic [5:0] estimate;
    logic [6:0] sixteenth;  // of the divisor, in bits of the thresholds
    logic from_2, from_3, from_4;  // the digit is that or more
    logic [ResWidth-1:0] a, b, c;
    estimate = {1'b0, x_doubled[ResWidth-1-:5]};
    sixteenth = {d[FracWidth-1-:4], 3'b000};
    from_2 = estimate >= First2[sixteenth+:6];
    from_3 = estimate >= First3[sixteenth+:6];
    from_4 = estimate >= First4[sixteenth+:6];
    digit = {from_2 & ~from_4, ~from_2 | (from_3 & ~from_4)};
    a = x_doubled | ResWidth'(1);
    b = ~({ResWidth{digit[0]}} & d);
    c = ~(({ResWidth{digit[1]}} & (d << 1)) | ({ResWidth{from_4}} & (d << 2)));
    sum = a ^ b ^ c;
    carry = (((a & b) | ((a ^ b) & c)) << 1) | ResWidth'(1);
  endtask

  // ---- Rows: residuals, and the digits so far, the first one at the top of the words

  logic [Rows+3:0] load;  // stage by stage: it takes a division in

  for (genvar r = 0; r <= Rows; r++) begin : gen_row
    localparam int unsigned DigitsWidth = 2 * (r + 1);
    logic [ResWidth-1:0] sum, carry, divisor;
    logic [DigitsWidth-1:0] positives, negatives;
    logic [BesideWidth-1:0] beside;

    if (r == 0) begin : gen_first
      assign negatives = 2'b00;
      if (Pipelined) begin : gen_registers
        always_ff @(posedge clk_i) begin
          if (load[0]) begin : take
            logic [ResWidth-1:0] first_sum, first_carry;
            logic [1:0] digit;
            divide_first(dividend_doubled, padded_divisor, first_sum, first_carry, digit);
            sum <= first_sum;
            carry <= first_carry;
            divisor <= padded_divisor;
            positives <= digit;
            beside <= beside_i;
          end
        end
      end else begin : gen_wires
        always_comb divide_first(dividend_doubled, padded_divisor, sum, carry, positives);
        assign divisor = padded_divisor;
        assign beside = beside_i;
      end
    end else begin : gen_next
      srt_row #(
        .Width(ResWidth),
        .DigitsWidth(DigitsWidth - 2),
        .BesideWidth(BesideWidth),
        .Arith(Arith),
        .Adder(Adder),
        .Pipelined(Pipelined)
      ) u_row (
        .clk_i,
        .enable_i(load[r]),
        .sum_i(gen_row[r-1].sum),
        .carry_i(gen_row[r-1].carry),
        .divisor_i(gen_row[r-1].divisor),
        .positives_i(gen_row[r-1].positives),
        .negatives_i(gen_row[r-1].negatives),
        .beside_i(gen_row[r-1].beside),
        .sum_o(sum),
        .carry_o(carry),
        .divisor_o(divisor),
        .positives_o(positives),
        .negatives_o(negatives),
        .beside_o(beside)
      );
    end
  end

  // ---- Remainder: a negative one takes a unit off the quotient. (Then it is d - |w|, never zero.)

  logic [ResWidth-1:0] remainder;
  logic [QuotientWidth-1:0] positives, negatives;
  logic [BesideWidth-1:0] beside;
  logic remainder_negative, remainder_left, unused_remainder_carry;
  logic [ResWidth-1:0] unused_divisor;

  assign unused_divisor = gen_row[Rows].divisor;

  adder #(
    .Width(ResWidth),
    .Arith(Arith),
    .Adder(Adder)
  ) u_remainder (
    .a_i(gen_row[Rows].sum),
    .b_i(gen_row[Rows].carry),
    .carry_i(1'b0),
    .sum_o(remainder),
    .carry_o(unused_remainder_carry)
  );

  // ---- Quotient: positive less negative digits, less that unit

  logic [QuotientWidth-1:0] quotient;
  logic unused_quotient_carry;

  adder #(
    .Width(QuotientWidth),
    .Arith(Arith),
    .Adder(Adder)
  ) u_quotient (
    .a_i(positives),
    .b_i(~negatives),
    .carry_i(~remainder_negative),
    .sum_o(quotient),
    .carry_o(unused_quotient_carry)
  );

  if (Pipelined) begin : gen_end_registers
    always_ff @(posedge clk_i) begin
      if (load[Rows+1]) begin
        {remainder_negative, remainder_left} <= {remainder[ResWidth-1], |remainder};
        positives <= gen_row[Rows].positives;
        negatives <= gen_row[Rows].negatives;
        beside <= gen_row[Rows].beside;
      end
      if (load[Rows+2]) {quotient_o, remainder_o, beside_o} <= {quotient, remainder_left, beside};
    end
  end else begin : gen_end_wires
    assign {remainder_negative, remainder_left} = {remainder[ResWidth-1], |remainder};
    assign positives = gen_row[Rows].positives;
    assign negatives = gen_row[Rows].negatives;
    assign beside = gen_row[Rows].beside;
    assign {quotient_o, remainder_o, beside_o} = {quotient, remainder_left, beside};
  end

  // ---- What is where

  logic [Rows+2:0] valid_q;  // behind each stage

  assign load = {Rows + 4{enable_i}} & {valid_q, valid_i};
  assign valid_o = Pipelined ? valid_q[Rows+2] : valid_i;
  if (Pipelined) begin : gen_valid
    always_ff @(posedge clk_i) if (enable_i) valid_q <= {valid_q[Rows+1:0], valid_i};
  end else begin : gen_no_valid
    logic unused;
    assign valid_q = '0;
    assign unused = clk_i & (|load);
  end

endmodule
