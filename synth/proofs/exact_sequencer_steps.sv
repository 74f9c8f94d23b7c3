// Claims: An instruction adds terms x y. For each term, exact_sequencer issues the product of digit i of x and digit j
// of y once, in column i + j, unless the sign of the result is known before. Columns come in order, and digit numbers
// stay in range, for any time at which signs become known. The watched product is an arbitrary one of an instruction.
// opened_exact_sequencer is exact_sequencer with its registers as outputs.
module exact_sequencer_steps #(
  parameter int unsigned Digits = 6,
  localparam int unsigned AddressWidth = $clog2(48 * Digits)
) (
  input logic       clk,
  input logic       begins,
  input logic       hit,
  input logic [1:0] against,
  input logic       start,
  input logic [5:0] coordinate_digits,
  input logic [5:0] direction_digits,
  input logic [5:0] pair_digits,
  input logic       written,
  input logic       stop,
  input logic [6:0] stop_address,
  input logic       abort,
  input logic [5:0] any_i,
  input logic [5:0] any_j,
  input logic [1:0] any_term
);

  logic reset_n;
  initial reset_n = 1'b0;
  always_ff @(posedge clk) reset_n <= 1'b1;

  logic stopped, valid, busy, beyond, more, advance, closes, ends, fire, first;
  logic [17:0] step;
  logic [6:0] address, address_q, next_q;
  logic [5:0] x_digit, i, j, from_i, from_j, column, x_last, y_last, last;
  logic [4:0] x_place, y_place;
  logic [1:0] term, terms_last;
  logic [40:0] instruction;
  logic [AddressWidth-1:0] x_address, y_address, result_address;

  opened_exact_sequencer dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .begin_i(begins),
    .hit_i(hit),
    .against_i(against),
    .start_i(start),
    .coordinate_digits_i(coordinate_digits),
    .direction_digits_i(direction_digits),
    .pair_digits_i(pair_digits),
    .written_i(written),
    .stop_i(stop),
    .stop_address_i(stop_address),
    .stopped_o(stopped),
    .abort_i(abort),
    .valid_o(valid),
    .step_o(step),
    .address_o(address),
    .x_digit_o(x_digit),
    .x_place_o(x_place),
    .y_place_o(y_place),
    .x_address_o(x_address),
    .y_address_o(y_address),
    .result_address_o(result_address),
    .instruction_q(instruction),
    .busy_q(busy),
    .term_q(term),
    .terms_last(terms_last),
    .i_q(i),
    .j_q(j),
    .from_i_q(from_i),
    .from_j_q(from_j),
    .column_q(column),
    .beyond_q(beyond),
    .first_q(first),
    .x_last_q(x_last),
    .y_last_q(y_last),
    .last_q(last),
    .more_q(more),
    .address_q(address_q),
    .next_q(next_q),
    .closes(closes),
    .ends(ends),
    .fire(fire),
    .advance(advance)
  );

  // ---- Assumptions about the user, exact_unit: the numbers of digits are constant while the sequencer is busy

  logic [19:0] counts, counts_before;
  assign counts = {against, coordinate_digits, direction_digits, pair_digits};
  always_ff @(posedge clk) counts_before <= counts;
  always_comb begin
    assume (!(start && busy) && !(begins && (busy || start)));
    assume (!busy || counts == counts_before);
    assume (coordinate_digits != '0 && coordinate_digits <= 6'(Digits));
    assume (direction_digits != '0 && direction_digits <= 6'(Digits));
    assume (pair_digits != '0 && pair_digits <= 6'd9);
  end

  // ---- The instruction: kind, order of columns (down: from high to low), and numbers of digits of x, y and result

  logic [2:0] kind;
  logic down, product;
  logic [5:0] n, fraction, x_digits, y_digits, result_digits;
  logic [1:0] terms;

  assign kind    = instruction[40:38];
  assign down    = instruction[37];
  assign product = kind >= 3'd3;
  assign n       = coordinate_digits << 1;
  assign fraction = n + ((coordinate_digits > direction_digits) ? coordinate_digits : direction_digits);
  always_comb begin
    x_digits = 6'd1;
    y_digits = 6'd1;
    result_digits = fraction;
    terms = 2'd1;
    case (kind)
      3'd0: result_digits = coordinate_digits;
      3'd1: result_digits = direction_digits;
      3'd2: result_digits = pair_digits;
      3'd3: {x_digits, y_digits, result_digits, terms} = {coordinate_digits, coordinate_digits, n, 2'd2};
      3'd4: {x_digits, y_digits, terms} = {coordinate_digits, n, 2'd3};
      3'd5: {x_digits, y_digits, terms} = {direction_digits, n, 2'd3};
      default: {x_digits, y_digits, terms} = {fraction, (against == 2'd2) ? fraction : pair_digits, 2'd2};
    endcase
    // An instruction that loads a number issues digit i of this number in column i
    if (!product) x_digits = result_digits;
  end

  // ---- The watched product, chosen when its instruction starts

  logic [5:0] w_i, w_j, w_column, here;
  logic [1:0] w_term, seen;
  logic in_range, out, passed, past;

  assign in_range = w_i < x_digits && w_j < y_digits && w_term < terms;
  assign w_column = w_i + w_j;
  assign here     = i + j;
  assign out      = fire && !beyond && i == w_i && j == w_j && term == w_term;
  always_ff @(posedge clk) begin
    if (start || advance) begin
      {w_i, w_j, w_term} <= {any_i, any_j, any_term};
      seen <= '0;
    end else if (out && seen != 2'd3) begin
      seen <= seen + 1'b1;
    end
  end
  assign passed = down ? w_column > here : beyond || w_column < here;  // the watched product's column is complete
  assign past   = w_column == here && !beyond && (i > w_i || (i == w_i && term > w_term));

  always_comb begin
    if (reset_n && busy) begin
      // Columns come in order
      assert (x_last == x_digits - 6'd1 && y_last == y_digits - 6'd1 && last == result_digits - 6'd1);
      assert (beyond || (i <= x_last && j <= y_last));
      assert (beyond || (from_i <= i && j <= from_j && from_i + from_j == here));
      assert (from_i == '0 || from_j == y_last);
      assert (from_i <= x_last && from_j <= y_last);
      assert (down ? !beyond : column <= last && (beyond ? column > x_last + y_last && from_i == x_last && from_j == y_last
                                                         : column == here));
      assert (term < terms && terms_last == terms - 2'd1);
      assert (!beyond || term == '0);
      assert (!first || (!beyond && term == '0 && i == from_i && (down ? i == x_last && j == y_last : i == '0 && j == '0)));
      assert (x_digits + y_digits <= 6'd37 && result_digits != '0);
      assert (product || !down);  // as in all programs
      assert (kind != 3'd7 && (kind != 3'd6 || down));
      // Each product is issued once, in its column
      assert (!in_range || seen == 2'((passed || past) ? 1 : 0));
      assert (!(advance && fire && !stopped && in_range) || seen + 2'(out) == 2'd1);
      assert (!valid || !product || beyond || (x_digit == i && step[3] == (term == '0 && i == from_i)));
      assert (!valid || step[2] == (beyond || (term == terms_last && (i == x_last || j == '0))));
    end
    cover (busy && kind == 3'd3 && beyond);
    cover (busy && stopped);
  end

endmodule
