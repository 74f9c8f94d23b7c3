// Exact unit: decides hits, limits and which of two hits is nearer.
//
// Gives the answers of host/exact, ties included, from the floats (binary32 or another format) of the ray and the
// corners. A, B, C are the corners minus the origin, I is the direction and N = (B - A) x (C - A):
//
//   hit    A . (B x C) is not 0; I . (B x C), I . (C x A), I . (A x B) have its sign. If one of these, I . M, is 0, the
//          sign of M's first non-zero component counts (as if I were tilted towards +x, less to +y, least to +z)
//   order  the sign of t - limit or t - t'. For hits, t = D / S > 0 with D = A . N and S = I . N, and t' = D' / S' (or
//          limit / 1). So the order is the sign of (D S' - D' S) D D'
//
// All these are sums of products of floats: whole numbers in units that come from the exponents (exact_exponents),
// summed without rounding. exact_program_pkg has the programs. Latency: at worst 3,686 clocks, or 161 if exponents are
// at most 21 apart (binary32, digits of 48 bits). The 161 are for hit and order; hit takes 72, limit 56, order 98.
//
// Coordinates are of magnitude 2**126 at most, the direction is not 0, the limit is positive; all are finite. hit_i and
// against_i select the questions. hit_o is high if hit_i was low. order_o is 0 for a miss or if no order was asked for;
// with hit_i low, misses are not detected. ready_o is high between an answer and the next request.
module exact_unit
  import exact_pkg::*;
#(
  parameter int unsigned ExpWidth = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned DigitWidth = 48,  // see exact_product and exact_slice
  parameter int unsigned Arith = arith_pkg::Graded,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    valid_i,
  output logic                    ready_o,
  input  logic                    hit_i,
  input  logic [1:0]              against_i,  // against_e
  input  logic [Floats*Width-1:0] floats_i,  // words: places of exact_pkg
  output logic                    valid_o,
  input  logic                    ready_i,
  output logic                    hit_o,
  output sign_t                   order_o
);

  localparam int unsigned Significand = FracWidth + 1;
  localparam int unsigned Digits = difference_digits(ExpWidth, Significand, DigitWidth);
  localparam int unsigned Depth = memory_depth(Digits);
  localparam int unsigned AddressWidth = $clog2(Depth);
  localparam int unsigned MaxShift = largest_gap(ExpWidth, Significand);
  localparam int unsigned ShiftWidth = $clog2(MaxShift + 1);
  localparam int unsigned Products = 6 * Digits;  // maximum number in a column
  localparam int unsigned SumWidth = sum_width(DigitWidth, Products);
  localparam int unsigned Stages = 4;

  // ---- Request: keeps the words, and waits for their exponents

  logic done, asks_hit_q;
  logic [1:0] against_q;
  logic [3:0] starts_q;
  logic [Floats*Width-1:0] floats_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      ready_o  <= 1'b1;
      starts_q <= '0;
    end else begin
      ready_o  <= ready_o ? ~valid_i : valid_o & ready_i;
      starts_q <= {starts_q[2:0], valid_i & ready_o};
    end
  end
  always_ff @(posedge clk_i) begin
    if (ready_o) begin
      asks_hit_q <= hit_i;
      against_q  <= against_i;
      floats_q   <= floats_i;
    end
  end

  logic [ExpWidth-1:0] coordinate_exponent, direction_exponent;
  logic [CountWidth-1:0] coordinate_digits, direction_digits, pair_digits;
  logic [ShiftWidth-1:0] one_shift, limit_shift;

  exact_exponents #(
    .ExpWidth  (ExpWidth),
    .FracWidth (FracWidth),
    .DigitWidth(DigitWidth)
  ) u_exponents (
    .clk_i,
    .floats_i             (floats_q),
    .with_other_i         (against_q == AgainstOther),
    .coordinate_exponent_o(coordinate_exponent),
    .direction_exponent_o (direction_exponent),
    .coordinate_digits_o  (coordinate_digits),
    .direction_digits_o   (direction_digits),
    .one_shift_o          (one_shift),
    .limit_shift_o        (limit_shift),
    .pair_digits_o        (pair_digits)
  );

  // ---- Issue: the sequencer's steps

  typedef struct packed {
    step_t step;
    logic [6:0] address;  // program address of the step's instruction
    logic [AddressWidth-1:0] result;  // address of the digit that the step completes
  } stage_t;

  logic [Stages:1] valid_q;
  stage_t issue;
  // verilator lint_off UNUSEDSIGNAL
  // Each stage uses some of the fields.
  stage_t [Stages:1] stage_q;
  // verilator lint_on UNUSEDSIGNAL
  logic [AddressWidth-1:0] x_address, y_address;
  logic [CountWidth-1:0] x_digit, x_digit_1_q;
  logic [NumberWidth-1:0] x_place, y_place;
  logic valid, stop, stopped;

  exact_sequencer #(
    .Digits(Digits)
  ) u_sequencer (
    .clk_i,
    .rst_ni,
    .begin_i            (starts_q[0]),
    .hit_i              (asks_hit_q),
    .against_i          (against_q),
    .start_i            (starts_q[3]),
    .coordinate_digits_i(coordinate_digits),
    .direction_digits_i (direction_digits),
    .pair_digits_i      (pair_digits),
    .written_i          (valid_q == '0),
    .stop_i             (stop),
    .stop_address_i     (stage_q[4].address),
    .stopped_o          (stopped),
    .abort_i            (done),
    .valid_o            (valid),
    .step_o             (issue.step),
    .address_o          (issue.address),
    .x_digit_o          (x_digit),
    .x_place_o          (x_place),
    .y_place_o          (y_place),
    .x_address_o        (x_address),
    .y_address_o        (y_address),
    .result_address_o   (issue.result)
  );

  function automatic logic [Width-1:0] word(logic [Floats*Width-1:0] words,
                                            logic [PlaceWidth-1:0] place);
    word = '0;
    for (int unsigned k = 0; k < Floats; k++) begin
      if (32'(place) == k) word = words[Width*k+:Width];
    end
  endfunction

  logic [1:0][Width-1:0] words_q;  // floats of x ([0]) and y
  logic one_q, limit_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= '0;
    else valid_q <= (stopped | done) ? '0 : {valid_q[Stages-1:1], valid};
  end
  always_ff @(posedge clk_i) begin
    stage_q     <= {stage_q[Stages-1:1], issue};
    x_digit_1_q <= x_digit;
    words_q     <= {word(floats_q, y_place), word(floats_q, x_place)};
    one_q       <= 32'(x_place) == PlaceOne;
    limit_q     <= 32'(x_place) == PlaceLimit;
  end

  // ---- Stage 1: digits of numbers, from memory, or of floats. Only x can be the limit or 1, which have own shifts

  logic write, loads;
  logic [DigitWidth-1:0] digit;
  logic [1:0][DigitWidth-1:0] operands_q;  // x, y
  logic [ShiftWidth-1:0] unit;
  logic x_negative_q, y_taken_q, loads_q;

  function automatic logic [ShiftWidth-1:0] exponent(logic [ExpWidth-1:0] field);
    exponent = (field == '0) ? ShiftWidth'(1) : ShiftWidth'(field);
  endfunction

  function automatic logic [Significand-1:0] significand(logic [Width-2:0] float);
    significand = {float[FracWidth+:ExpWidth] != '0, float[FracWidth-1:0]};
  endfunction

  assign loads = stage_q[1].step.kind < KindCross;
  assign unit = (stage_q[1].step.kind == KindRay) ? ShiftWidth'(direction_exponent)
                                                      : ShiftWidth'(coordinate_exponent);

  for (genvar n = 0; n < 2; n++) begin : gen_operand
    logic is_one, is_limit;
    logic [DigitWidth-1:0] stored, slice;

    assign is_one   = (n == 0) & one_q;
    assign is_limit = (n == 0) & limit_q;

    ram #(
      .Width(DigitWidth),
      .Depth(Depth)
    ) u_digits (
      .clk_i,
      .write_i        (write),
      .write_address_i(stage_q[4].result),
      .data_i         (digit),
      .read_i         (1'b1),
      .read_address_i ((n == 0) ? x_address : y_address),
      .data_o         (stored)
    );
    exact_slice #(
      .SignificandWidth(Significand),
      .MaxShift        (MaxShift),
      .DigitWidth      (DigitWidth)
    ) u_slice (
      .significand_i(is_one ? Significand'(1) : significand(words_q[n][Width-2:0])),
      .shift_i      (is_one ? one_shift : is_limit ? limit_shift
                     : exponent(words_q[n][FracWidth+:ExpWidth]) - unit),
      .digit_i      (x_digit_1_q),
      .digit_o      (slice)
    );
    always_ff @(posedge clk_i) operands_q[n] <= loads ? slice : stored;
  end

  always_ff @(posedge clk_i) begin
    x_negative_q <= words_q[0][Width-1];
    y_taken_q    <= ~words_q[1][Width-1];
    loads_q      <= loads;
  end

  // ---- Stage 2: a product, or a difference, as two words

  logic [SumWidth-1:0] product_sum, product_carry, difference_sum, difference_carry, sum_q, carry_q;

  exact_product #(
    .DigitWidth(DigitWidth),
    .Width     (SumWidth),
    .Arith     (Arith)
  ) u_product (
    .a_i     (operands_q[0]),
    .b_i     (operands_q[1]),
    .negate_i(stage_q[2].step.negate),
    .sum_o   (product_sum),
    .carry_o (product_carry)
  );

  carry_save_adder #(
    .Width(SumWidth)
  ) u_difference (
    .a_i    (SumWidth'(operands_q[0]) ^ {SumWidth{x_negative_q}}),
    .b_i    (SumWidth'(operands_q[1]) ^ {SumWidth{y_taken_q}}),
    .c_i    (SumWidth'(x_negative_q)),
    .sum_o  (difference_sum),
    .carry_o(difference_carry)
  );

  always_ff @(posedge clk_i) begin
    sum_q   <= stage_q[2].step.empty ? '0 : loads_q ? difference_sum : product_sum;
    carry_q <= stage_q[2].step.empty ? '0
             : loads_q ? difference_carry | SumWidth'(y_taken_q) : product_carry;
  end

  // ---- Stage 3: the sum

  logic sum_negative, sum_zero, sure;

  exact_accumulator #(
    .DigitWidth(DigitWidth),
    .Products  (Products),
    .Arith     (Arith)
  ) u_accumulator (
    .clk_i,
    .opens_i   (stage_q[3].step.opens),
    .first_i   (stage_q[3].step.first),
    .down_i    (stage_q[3].step.down),
    .sum_i     (sum_q),
    .carry_i   (carry_q),
    .digit_o   (digit),
    .negative_o(sum_negative),
    .zero_o    (sum_zero),
    .sure_o    (sure)
  );

  // ---- Stage 4: a digit is written; a number has the sign of its highest non-zero digit

  logic [Numbers-1:0] negative_q, nonzero_q;

  assign write = valid_q[4] & stage_q[4].step.closes & ~stage_q[4].step.down;

  always_ff @(posedge clk_i) begin
    if (write && (stage_q[4].step.low || digit != '0)) begin
      negative_q[stage_q[4].step.result] <= digit[DigitWidth-1];
      nonzero_q[stage_q[4].step.result]  <= digit != '0;
    end
  end

  // ---- Stage 4: a sign is known

  logic decided_q, was_decided;
  sign_t sum_sign, tie_sign, sign, plane_q;

  assign was_decided = decided_q & ~stage_q[4].step.first;
  assign stop = valid_q[4] & stage_q[4].step.down & stage_q[4].step.closes & ~was_decided
              & (sure | stage_q[4].step.ends);

  always_ff @(posedge clk_i) begin
    if (valid_q[4]) decided_q <= was_decided | stop;
  end

  // For an edge that the ray meets: the sign of the first non-zero component of the edge's normal.
  always_comb begin
    tie_sign = '0;
    for (int unsigned k = 3; k > 0; k--) begin
      if (stage_q[4].step.second && nonzero_q[SecondNormal+k-1]) begin
        tie_sign = {negative_q[SecondNormal+k-1], 1'b1};
      end
      if (!stage_q[4].step.second && nonzero_q[Normal+k-1]) begin
        tie_sign = {negative_q[Normal+k-1], 1'b1};
      end
    end
  end
  assign sum_sign = {sum_negative & ~sum_zero, ~sum_zero};
  assign sign = (stage_q[4].step.kind == KindEdge && sum_zero) ? tie_sign : sum_sign;

  // ---- The answer

  logic misses, hits, compares, order_negative, order_nonzero;

  assign misses = stop & ((stage_q[4].step.kind == KindPlane) ? sum_zero
                          : (stage_q[4].step.kind == KindEdge) & (sign != plane_q));
  assign hits = stop & ~misses & stage_q[4].step.last & (against_q == AgainstNothing);
  assign compares = stop & (stage_q[4].step.kind == KindCompare);
  assign done = misses | hits | compares;
  assign order_nonzero = sign.nonzero & nonzero_q[Distance]
                       & nonzero_q[OtherDistance];
  assign order_negative = sign.negative ^ negative_q[Distance]
                        ^ negative_q[OtherDistance];

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_o <= 1'b0;
    else valid_o <= done | (valid_o & ~ready_i);
  end
  always_ff @(posedge clk_i) begin
    if (stop && stage_q[4].step.kind == KindPlane) plane_q <= sum_sign;
    if (done) begin
      hit_o   <= ~misses;
      order_o <= compares ? {order_negative & order_nonzero, order_nonzero} : '0;
    end
  end

endmodule
