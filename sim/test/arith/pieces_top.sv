// The small modules of hw/arith, each beside what the language's own operators give.
//
// Bit n of wrong_o is set where piece n differs; spoil_i falsifies what is expected of every one.
module pieces_top (
  input  logic        clk_i,
  input  logic [47:0] a_i,
  input  logic [47:0] b_i,
  input  logic [47:0] c_i,
  input  logic        carry_i,
  input  logic        spoil_i,
  output logic [15:0] wrong_o,
  // srt_row: w = row_sum_i + row_carry_i, |w| <= 2/3 d
  input  logic [24:0] row_sum_i,
  input  logic [24:0] row_carry_i,
  input  logic [24:0] row_divisor_i,
  output logic [1:0]  row_wrong_o,    // a bit for each kind of arithmetic
  output logic        first_wrong_o,  // srt_first_row, of dividend_i and divisor_i
  // sticky_right_shift of a_i by the low bits of b_i
  output logic [47:0] shifted_o,
  output logic        lost_o,
  // srt_divider_stages, in one go and pipelined
  input  logic        valid_i,
  input  logic [23:0] dividend_i,
  input  logic [23:0] divisor_i,
  output logic [63:0] quotient_o,    // 32 bits for each kind: {quotient, remainder left}
  output logic [1:0]  valid_o,       // of the pipelined ones
  output logic [95:0] pipelined_o    // 48 bits for each kind: the same, and the operands' low bits
);

  logic [47:0] a, b, c;
  logic carry, spoil;

  always_ff @(posedge clk_i) {a, b, c, carry, spoil} <= {a_i, b_i, c_i, carry_i, spoil_i};

  logic [48:0] total;
  assign total = 49'(a) + 49'(b) + 49'(carry) + 49'(spoil);

  // ---- 0 to 3: adders

  for (genvar n = 0; n < 3; n++) begin : gen_adder
    logic [47:0] sum;
    logic carry_out;
    if (n == 0) begin : gen_ripple
      ripple_carry_adder #(.Width(48)) u_adder (
        .a_i(a), .b_i(b), .carry_i(carry), .sum_o(sum), .carry_o(carry_out));
    end else if (n == 1) begin : gen_select
      carry_select_adder #(.Width(48)) u_adder (
        .a_i(a), .b_i(b), .carry_i(carry), .sum_o(sum), .carry_o(carry_out));
    end else begin : gen_prefix
      prefix_adder #(.Width(48)) u_adder (
        .a_i(a), .b_i(b), .carry_i(carry), .sum_o(sum), .carry_o(carry_out));
    end
    assign wrong_o[n] = {carry_out, sum} != total;
  end

  logic bit_sum, bit_carry;
  full_adder u_full_adder (
    .a_i(a[0]), .b_i(b[0]), .carry_i(carry), .sum_o(bit_sum), .carry_o(bit_carry));
  assign wrong_o[3] = {bit_carry, bit_sum} != 2'(a[0]) + 2'(b[0]) + 2'(carry) + 2'(spoil);

  // ---- 4, 5: the groups of carry-select adders, for both carries

  localparam bit [8*arith_pkg::MaxGroups-1:0] Groups = arith_pkg::graded_groups(48);
  localparam int unsigned NumGroups = arith_pkg::num_groups(Groups);

  for (genvar n = 0; n < 2; n++) begin : gen_sums
    logic [47:0] sum_0, sum_1;
    logic [NumGroups-1:0] carry_0, carry_1, wrong;
    if (n == 0) begin : gen_ripple
      conditional_sums_ripple #(.Width(48), .GroupWidths(Groups)) u_sums (
        .a_i(a), .b_i(b), .carry_i(carry), .sum_0_o(sum_0), .sum_1_o(sum_1),
        .carry_0_o(carry_0), .carry_1_o(carry_1));
    end else begin : gen_look_ahead
      conditional_sums_look_ahead #(.Width(48), .GroupWidths(Groups)) u_sums (
        .a_i(a), .b_i(b), .carry_i(carry), .sum_0_o(sum_0), .sum_1_o(sum_1),
        .carry_0_o(carry_0), .carry_1_o(carry_1));
    end
    for (genvar k = 0; k < NumGroups; k++) begin : gen_group
      localparam int unsigned Low = arith_pkg::group_low(Groups, k);
      localparam int unsigned Bits = 32'(Groups[8*k +: 8]);
      logic enters;
      logic [Bits:0] expected;  // with no carry into the group but the lowest
      assign enters = (k == 0) & carry;
      assign expected = (Bits + 1)'(a[Low +: Bits]) + (Bits + 1)'(b[Low +: Bits])
                      + (Bits + 1)'(enters) + (Bits + 1)'(spoil);
      assign wrong[k] = ({carry_0[k], sum_0[Low +: Bits]} != expected)
                      | (k > 0 ? {carry_1[k], sum_1[Low +: Bits]} != expected + 1'b1 : 1'b0);
    end
    assign wrong_o[4+n] = |wrong;
  end

  // ---- 6 to 9: incrementers and comparators of five widths, structural and behavioural

  localparam bit [8*5-1:0] Widths = {8'd48, 8'd31, 8'd8, 8'd3, 8'd2};

  for (genvar n = 0; n < 2; n++) begin : gen_kind
    logic [4:0] wrong_increment, wrong_compare;
    for (genvar w = 0; w < 5; w++) begin : gen_width
      localparam int unsigned Width = 32'(Widths[8*w +: 8]);
      logic [Width-1:0] next;
      logic less, equal;
      incrementer #(.Width(Width), .Arith(n)) u_incrementer (
        .a_i(a[Width-1:0]), .carry_i(carry), .sum_o(next));
      comparator #(.Width(Width), .Arith(n)) u_comparator (
        .a_i(a[Width-1:0]), .b_i(b[Width-1:0]), .less_o(less), .equal_o(equal));
      assign wrong_increment[w] = next != a[Width-1:0] + Width'(carry) + Width'(spoil);
      assign wrong_compare[w] = (less != (a[Width-1:0] < b[Width-1:0]))
                              | ((equal ^ spoil) != (a[Width-1:0] == b[Width-1:0]));
    end
    assign wrong_o[6+2*n] = |wrong_increment;
    assign wrong_o[7+2*n] = |wrong_compare;
  end

  // ---- 10: multiplexer, plain and ordered; 11: carry-save adder

  logic [47:0] chosen, chosen_ordered, saved_sum, saved_carry;

  multiplexer #(.Width(48)) u_multiplexer (
    .select_i(c), .when_0_i(a), .when_1_i(b), .out_o(chosen));
  multiplexer #(.Width(48), .Ordered(1'b1)) u_ordered (
    .select_i(c), .when_0_i(a & b), .when_1_i(b), .out_o(chosen_ordered));
  assign wrong_o[10] = (chosen != (((c & b) | (~c & a)) ^ 48'(spoil)))
                     | (chosen_ordered != ((c & b) | (~c & a & b)));
  carry_save_adder #(.Width(48)) u_carry_save (
    .a_i(a), .b_i(b), .c_i(c), .sum_o(saved_sum), .carry_o(saved_carry));
  assign wrong_o[11] = saved_sum + saved_carry != a + b + c + 48'(spoil);

  // ---- 12, 13: Booth digits and rows

  logic [25:0] one, two, negative;
  logic [51:0] digits;  // what they are worth together
  logic [12:0] wrong_row;

  booth_encoder #(.Width(24)) u_encoder (
    .b_i(b[23:0]), .one_o(one), .two_o(two), .negative_o(negative));
  always_comb begin
    digits = '0;
    for (int unsigned k = 0; k < 13; k++) begin
      digits = negative[2*k] ? digits - (52'({two[2*k], one[2*k]}) << 2 * k)
                             : digits + (52'({two[2*k], one[2*k]}) << 2 * k);
    end
  end
  assign wrong_o[12] = (digits != 52'(b[23:0]) + 52'(spoil)) | (|(one & two))
                     | (|((one | two | negative) & {13{2'b10}}));
  for (genvar k = 0; k < 13; k++) begin : gen_row
    logic [24:0] row;
    logic [26:0] value, multiple;
    booth_row #(.Width(24)) u_row (
      .a_i(a[23:0]), .one_i(one[2*k]), .two_i(two[2*k]), .negative_i(negative[2*k]), .row_o(row));
    assign value = 27'(row) + 27'(negative[2*k]) - (27'(negative[2*k]) << 25) + 27'(spoil);
    assign multiple = 27'(a[23:0]) * 27'({two[2*k], one[2*k]});
    assign wrong_row[k] = value != (negative[2*k] ? -multiple : multiple);
  end
  assign wrong_o[13] = |wrong_row;

  // ---- 14, 15: leading zeros and a product, as the larger tops have them in every width

  logic [5:0] zeros;
  logic zero;
  logic [47:0] shifted, product;

  leading_zero_counter #(.Width(48)) u_zeros (.a_i(a), .count_o(zeros), .zero_o(zero));
  assign shifted = a << zeros;
  assign wrong_o[14] = (zero != (a == '0)) | (zero ? spoil : shifted[47] == spoil)
                     | (~zero & (shifted >> zeros != a));
  multiplier #(.Width(24)) u_multiplier (.a_i(a[23:0]), .b_i(b[23:0]), .product_o(product));
  assign wrong_o[15] = product != 48'(a[23:0]) * 48'(b[23:0]) + 48'(spoil);

  // ---- One row of the divider: 4 w - digit * d = w', and |w'| <= 2/3 d again

  logic [24:0] row_sum, row_carry, row_divisor;
  always_ff @(posedge clk_i) begin
    {row_sum, row_carry, row_divisor} <= {row_sum_i, row_carry_i, row_divisor_i};
  end

  for (genvar n = 0; n < 2; n++) begin : gen_srt_row
    logic [24:0] sum, carry_word;
    logic [1:0] plus, minus;
    logic signed [31:0] old_w, new_w, digit, d;

    srt_row #(.Width(25), .Arith(n)) u_row (
      .sum_i(row_sum), .carry_i(row_carry), .divisor_i(row_divisor), .sum_o(sum),
      .carry_o(carry_word), .positive_o(plus), .negative_o(minus));
    assign old_w = 32'(signed'(25'(row_sum + row_carry)));
    assign new_w = 32'(signed'(25'(sum + carry_word)));
    assign digit = 32'(plus) - 32'(minus);
    assign d = 32'(row_divisor);
    assign row_wrong_o[n] = (new_w != 4 * old_w - digit * d) | (3 * new_w > 2 * d)
                          | (3 * new_w < -2 * d);
  end

  // ---- The first row: 2 x - digit * d = w, digit in 1 .. 4

  logic [24:0] first_sum, first_carry;
  logic [1:0] first_code;
  logic signed [31:0] first_w, first_digit, first_d;

  srt_first_row #(.Width(25)) u_first_row (
    .dividend_doubled_i({dividend_i, 1'b0}), .divisor_i({1'b0, divisor_i}), .sum_o(first_sum),
    .carry_o(first_carry), .digit_o(first_code));
  assign first_w = 32'(signed'(25'(first_sum + first_carry)));
  assign first_digit = (first_code == 2'd0) ? 4 : 32'(first_code);
  assign first_d = 32'(divisor_i);
  assign first_wrong_o = (first_w != 32'({dividend_i, 1'b0}) - first_digit * first_d)
                       | (3 * first_w > 2 * first_d) | (3 * first_w < -2 * first_d);

  // ---- The shift

  sticky_right_shift #(.Width(48), .AmountWidth(9)) u_shift (
    .a_i(a), .amount_i(b[8:0]), .shifted_o, .lost_o);

  // ---- The whole division

  for (genvar n = 0; n < 2; n++) begin : gen_divider
    logic unused_side, unused_valid;
    logic [5:0] unused_gap;

    srt_divider_stages #(.Width(24), .Rows(12), .Arith(n)) u_whole (
      .clk_i, .valid_i, .dividend_i, .divisor_i, .side_i(1'b0),
      .quotient_o(quotient_o[32*n+1 +: 26]), .remainder_o(quotient_o[32*n]),
      .side_o(unused_side), .valid_o(unused_valid));
    assign quotient_o[32*n+27 +: 5] = '0;
    srt_divider_stages #(
      .Width(24), .Rows(12), .SideWidth(20), .Arith(n), .PipeRegs(32'hffff_ffff)
    ) u_pipelined (
      .clk_i, .valid_i, .dividend_i, .divisor_i,
      .side_i({dividend_i[9:0], divisor_i[9:0]}),
      .quotient_o(pipelined_o[48*n+1 +: 26]), .remainder_o(pipelined_o[48*n]),
      .side_o(pipelined_o[48*n+27 +: 20]), .valid_o(valid_o[n]));
    assign pipelined_o[48*n+47] = 1'b0;
    assign unused_gap = '0;
  end

endmodule
