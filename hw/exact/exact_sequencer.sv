// Sequencer of the exact unit: steps of programs, a product a clock.
//
// For a number, columns are computed upwards, from column 0 to the last digit; for a sign downwards, from the highest.
// A column has one step for each pair of its digits and each term (product) of the instruction. An instruction with a
// fence begins when written_i is high (all earlier results are written). stop_i: the sign of the instruction at
// stop_address_i is known. If this instruction is still being issued, its other steps are skipped. After Hit, the
// comparison is issued before it is known whether there is a hit; abort_i ends the program.
//
// start_i: the counts of digits are valid, except pair_digits_i, which is valid a clock later. The first step is issued
// in the clock after start_i.
module exact_sequencer
  import exact_pkg::*;
#(
  parameter int unsigned Digits = 6,  // maximum number of digits of a difference
  localparam int unsigned AddressWidth = $clog2(memory_depth(Digits))
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  // a request
  input  logic                    begin_i,
  input  logic                    hit_i,
  input  logic [1:0]              against_i,
  input  logic                    start_i,
  input  logic [CountWidth-1:0]   coordinate_digits_i,
  input  logic [CountWidth-1:0]   direction_digits_i,
  input  logic [CountWidth-1:0]   pair_digits_i,
  // results so far
  input  logic                    written_i,
  input  logic                    stop_i,
  input  logic [6:0]              stop_address_i,
  output logic                    stopped_o,  // stop_i, and all steps in flight are superfluous
  input  logic                    abort_i,
  // a step
  output logic                    valid_o,
  output step_t                   step_o,
  output logic [6:0]              address_o,
  output logic [CountWidth-1:0]   x_digit_o,
  output logic [NumberWidth-1:0]  x_place_o,
  output logic [NumberWidth-1:0]  y_place_o,
  output logic [AddressWidth-1:0] x_address_o,
  output logic [AddressWidth-1:0] y_address_o,
  output logic [AddressWidth-1:0] result_address_o
);

  // ---- Fetch: the next instruction, and the indices of the last digits of its x, y and result

  instruction_t fetched, instruction_q;
  logic [6:0] compares, next_q, address_q;
  logic more_q, busy_q, advance, finishes;
  logic [CountWidth-1:0] x_last_d, y_last_d, last_d, x_last_q, y_last_q, last_q;
  logic [CountWidth-1:0] normal_digits, fraction_digits;

  assign fetched = exact_program_pkg::Program[next_q];
  assign normal_digits = coordinate_digits_i << 1;
  assign fraction_digits = normal_digits
      + ((coordinate_digits_i > direction_digits_i) ? coordinate_digits_i : direction_digits_i);

  always_comb begin
    x_last_d = coordinate_digits_i - 1'b1;
    y_last_d = '0;
    last_d   = fraction_digits - 1'b1;
    case (fetched.kind)
      KindCoordinate: last_d = coordinate_digits_i - 1'b1;
      KindRay: begin
        x_last_d = direction_digits_i - 1'b1;
        last_d   = direction_digits_i - 1'b1;
      end
      KindPair: begin
        x_last_d = pair_digits_i - 1'b1;
        last_d   = pair_digits_i - 1'b1;
      end
      KindCross: begin
        y_last_d = coordinate_digits_i - 1'b1;
        last_d   = normal_digits - 1'b1;
      end
      KindPlane: y_last_d = normal_digits - 1'b1;
      KindEdge: begin
        x_last_d = direction_digits_i - 1'b1;
        y_last_d = normal_digits - 1'b1;
      end
      default: begin
        x_last_d = fraction_digits - 1'b1;
        y_last_d = pair_digits_i - 1'b1;
        if (against_i == AgainstOther) y_last_d = fraction_digits - 1'b1;
      end
    endcase
  end

  // The program after Hit; `finishes`: no instruction follows the fetched one.
  assign compares = (against_i == AgainstLimit) ? exact_program_pkg::Limit
                                                : exact_program_pkg::Order;
  assign finishes = (fetched.kind == KindCompare)
                  | (fetched.last & (against_i == AgainstNothing));

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) busy_q <= 1'b0;
    else if (abort_i) busy_q <= 1'b0;
    else if (start_i | advance) busy_q <= start_i | more_q;
  end
  always_ff @(posedge clk_i) begin
    if (begin_i) begin
      next_q <= hit_i ? exact_program_pkg::Hit : compares;
    end else if (start_i | advance) begin
      next_q        <= fetched.last ? compares : next_q + 1'b1;
      more_q        <= ~finishes;
      address_q     <= next_q;
      instruction_q <= fetched;
      x_last_q      <= x_last_d;
      y_last_q      <= y_last_d;
      last_q        <= last_d;
    end
  end

  // ---- Steps: the term, digit i of x and digit j of y; from_i and from_j are the first i and j of the column

  logic [1:0] term_q, terms_last;
  logic [CountWidth-1:0] i_q, j_q, from_i_q, from_j_q, from_i_d, from_j_d, column_q;
  logic beyond_q, beyond_d, first_q;
  logic single, is_last_term, closes, ends, fire;

  assign single = instruction_q.kind < KindCross;
  assign terms_last = single ? 2'd0
                    : (instruction_q.kind == KindPlane
                       || instruction_q.kind == KindEdge) ? 2'd2 : 2'd1;
  assign is_last_term = term_q == terms_last;
  assign closes = beyond_q | (is_last_term & (i_q == x_last_q || j_q == '0));
  assign ends = instruction_q.decide ? from_i_q == '0 && from_j_q == '0 : column_q == last_q;
  assign stopped_o = stop_i & busy_q & (stop_address_i == address_q);
  assign fire = busy_q & ~(instruction_q.fence & first_q & ~written_i);
  assign advance = stopped_o | (fire & closes & ends);

  always_comb begin
    from_i_d = from_i_q;
    from_j_d = from_j_q;
    beyond_d = beyond_q;
    if (instruction_q.decide) begin
      if (from_i_q != '0) from_i_d = from_i_q - 1'b1;
      else from_j_d = from_j_q - 1'b1;
    end else if (from_j_q != y_last_q) begin
      from_j_d = from_j_q + 1'b1;
    end else if (from_i_q != x_last_q) begin
      from_i_d = from_i_q + 1'b1;
    end else begin
      beyond_d = 1'b1;  // no products, only the carry
    end
  end

  always_ff @(posedge clk_i) begin
    if (start_i | advance) begin
      term_q   <= '0;
      i_q      <= fetched.decide ? x_last_d : '0;
      j_q      <= fetched.decide ? y_last_d : '0;
      from_i_q <= fetched.decide ? x_last_d : '0;
      from_j_q <= fetched.decide ? y_last_d : '0;
      column_q <= '0;
      beyond_q <= 1'b0;
      first_q  <= 1'b1;
    end else if (fire) begin
      first_q <= 1'b0;
      term_q  <= is_last_term ? '0 : term_q + 1'b1;
      if (closes) begin
        term_q   <= '0;
        i_q      <= from_i_d;
        j_q      <= from_j_d;
        from_i_q <= from_i_d;
        from_j_q <= from_j_d;
        column_q <= column_q + 1'b1;
        beyond_q <= beyond_d;
      end else if (is_last_term) begin
        i_q <= i_q + 1'b1;
        j_q <= j_q - 1'b1;
      end
    end
  end

  // ---- The step

  function automatic logic [AddressWidth-1:0] first_digit(logic [NumberWidth-1:0] number);
    first_digit = '0;
    for (int unsigned n = 0; n < Numbers; n++) begin
      if (32'(number) == n) first_digit = AddressWidth'(number_base(n, Digits));
    end
  endfunction

  assign valid_o   = fire & ~stopped_o;
  assign address_o = address_q;
  assign x_digit_o = i_q;
  assign x_place_o = (term_q == 2'd0) ? instruction_q.x0
                   : (term_q == 2'd1) ? instruction_q.x1 : instruction_q.x2;
  assign y_place_o = (term_q == 2'd0) ? instruction_q.y0
                   : (term_q == 2'd1) ? instruction_q.y1 : instruction_q.y2;
  assign x_address_o = first_digit(x_place_o) + AddressWidth'(i_q);
  assign y_address_o = first_digit(y_place_o) + AddressWidth'(j_q);
  assign result_address_o = first_digit(instruction_q.result) + AddressWidth'(column_q);

  always_comb begin
    step_o.kind   = instruction_q.kind;
    step_o.down   = instruction_q.decide;
    step_o.last   = instruction_q.last;
    step_o.second = 32'(instruction_q.y0) == SecondNormal;
    step_o.result = instruction_q.result;
    step_o.negate = terms_last == 2'd1 && term_q == 2'd1;
    step_o.empty  = beyond_q;
    step_o.first  = first_q;
    step_o.opens  = beyond_q | (term_q == 2'd0 && i_q == from_i_q);
    step_o.closes = closes;
    step_o.ends   = ends;
    step_o.low    = column_q == '0;
  end

endmodule
