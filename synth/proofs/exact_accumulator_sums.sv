// Claims for any terms: The register of exact_accumulator is the exact sum of a column's terms and an incoming value,
// and does not overflow. From low to high columns, the incoming value is the carry out of the column below. From high
// to low columns, the incoming value is the sum of the column above times 2**DigitWidth. digit_o is the register modulo
// 2**DigitWidth, as a signed number. If sure_o is set, the sum's magnitude exceeds any total of all columns below.
// opened_exact_accumulator is exact_accumulator with its register as an output.
module exact_accumulator_sums #(
  parameter int unsigned DigitWidth = 48,
  parameter int unsigned Products   = 36,
  localparam int unsigned Width = 2 * DigitWidth + $clog2(Products) + 1,
  localparam int unsigned Wide = 3 * DigitWidth + 20
) (
  input logic             clk,
  input logic             opens,
  input logic             first,
  input logic             down,
  input logic [Width-1:0] sum_word,
  input logic [Width-1:0] carry_word
);

  logic negative, zero, sure;
  logic [DigitWidth-1:0] digit_word;
  logic [Width-1:0] sum_q;

  opened_exact_accumulator dut (
    .clk_i     (clk),
    .opens_i   (opens),
    .first_i   (first),
    .down_i    (down),
    .sum_i     (sum_word),
    .carry_i   (carry_word),
    .digit_o   (digit_word),
    .negative_o(negative),
    .zero_o    (zero),
    .sure_o    (sure),
    .sum_q
  );

  // The term: a product of two digits with magnitudes of at most 2**(DigitWidth-1)
  logic [Width-1:0] term_word;
  logic signed [Wide-1:0] term, largest;
  assign term_word = sum_word + carry_word;
  assign term      = $signed(term_word);
  assign largest   = Wide'(1) << (2 * DigitWidth - 2);

  // Assumptions about the user, exact_unit
  logic begun, was_down;
  logic [7:0] terms;  // number of the column's terms
  initial {begun, was_down, terms} = '0;
  always_ff @(posedge clk) begin
    begun    <= 1'b1;
    was_down <= down;
    terms    <= opens ? 8'd1 : terms + 1'b1;
  end
  always_comb begin
    assume (begun || first);
    assume (!first || opens);
    assume (first || down == was_down);
    assume (opens || terms < Products);
    assume (-largest <= term && term <= largest);
    assume (!(opens && !first && down && sure));  // the unit stops at a sure sign
  end

  // The expected sum, in a wider word
  logic signed [Wide-1:0] digit, left, over, above, sum, size;
  assign digit = $signed(digit_word);
  assign left  = sum - digit;
  assign over  = left >>> DigitWidth;
  assign above = sum <<< DigitWidth;
  assign size  = sum[Wide-1] ? -sum : sum;
  initial sum = '0;
  always_ff @(posedge clk) sum <= first ? term : !opens ? sum + term : down ? above + term : over + term;

  // Largest magnitudes. bound: of the sum; most: of the incoming value; tail: of the sum of one column's products
  localparam int unsigned SureBit = DigitWidth - 1 + $clog2(Products);
  logic [Wide-1:0] most, bound, tail;
  assign most  = was_down ? Wide'(1) << (SureBit + DigitWidth) : Wide'(Products) << (DigitWidth - 1);
  assign bound = most + (Wide'(terms) << (2 * DigitWidth - 2));
  assign tail  = Wide'(Products) << (2 * DigitWidth - 2);

  always_comb begin
    if (begun) begin
      assert (sum == $signed(sum_q));
      assert ($unsigned(size) <= bound);
      assert (terms != '0 && terms <= Products);
      assert (negative == sum[Wide-1] && zero == (sum == '0));
      assert (left[DigitWidth-1:0] == '0);
      // With B = 2**DigitWidth, the k-th column below adds at most tail / B**k, all together less than tail / (B - 1)
      assert (!sure || $unsigned((size <<< DigitWidth) - size) >= tail);
    end
    cover (begun && sure && was_down);
    cover (begun && !was_down && terms == 8'd3 && negative);
  end

endmodule
