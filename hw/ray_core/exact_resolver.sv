// Resolver of doubts: asks exact_unit what closest_hit leaves open. So no doubt leaves the core.
//
// For each ray it keeps the candidate: the nearest of the ray's doubts that are hits.
//
//   a doubt   Does the ray hit its triangle (asked unless this is certain), and is the hit nearer than the candidate,
//             if there is one? If so, the doubt becomes the candidate.
//   settling  When nothing else is left to do for the ray: is the candidate nearer than closest_hit's certain hit or,
//             without such a hit, than the user's t_max? If so, its triangle is tested once more, for t and P.
//
// Of hits at the same t, the hit on the triangle of lower rank is nearer. Latency: exact_unit's plus 8 clocks (a
// question, without its one or two reads of the triangle cache). A ray has one question at a time; Units exact_units
// share the rays' questions. Doubts of an ended ray are dropped.
//
// closest_hit's credits reserve a place in this queue for every doubt, so no test waits for the resolver. (Otherwise a
// test could wait for the resolver, and the resolver for a line behind that test's line: a deadlock.)
module exact_resolver
  import ray_core_pkg::*;
#(
  parameter int unsigned Rays  = 64,
  parameter int unsigned Units = 1,
  parameter int unsigned Queue = 2 * Rays + 128,  // doubts: all tests that can be in flight
  parameter int unsigned Arith = arith_pkg::Graded,
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  // a ray begins
  input  logic                    load_i,
  input  logic [RayWidth-1:0]     load_ctx_i,
  input  logic [95:0]             load_origin_i,
  input  logic [95:0]             load_direction_i,
  // a doubt of closest_hit enters the queue; taken_o: a doubt leaves the queue
  input  logic [RayWidth-1:0]     open_ctx_i,
  input  open_t                   open_i,
  output logic                    taken_o,
  // idle_i: rays without nodes, leaves and tests; busy_o: rays that have doubts or a candidate
  input  logic [Rays-1:0]         idle_i,
  output logic [Rays-1:0]         busy_o,
  // ctx_o: the ray that the current question is about; known_i: what closest_hit knows of it, in the same clock
  output logic [RayWidth-1:0]     ctx_o,
  input  known_t                  known_i,
  // requests for triangle lines for this ray; exact: 1 for a question's corners, 0 for a candidate's last test
  output triangle_request_t       request_o,
  input  logic                    request_ready_i,
  input  triangle_line_t          line_i,
  output logic                    computing_o  // an exact_unit has a question
);

  localparam int unsigned CountWidth = $clog2(Queue + 1);
  localparam int unsigned CornersWidth = 9 * 32;
  localparam int unsigned AboutWidth = 1 + RayWidth + AddressWidth;  // {settling, context, line}

  if (Units < 1) begin : gen_check
    $error("exact_resolver: expected Units of 1 or more");
  end

  typedef enum logic [2:0] {
    StateIdle   = 3'd0,  // takes an answer or, if a unit is free, begins a question
    StateLook   = 3'd1,  // reads what is known of the ray
    StateChoose = 3'd2,  // chooses what to ask
    StateFetch  = 3'd3,  // requests a line
    StateWait   = 3'd4,  // waits for the line
    StateAsk    = 3'd5,
    StateAnswer = 3'd6,  // evaluates the answer; the end
    StateTest   = 3'd7   // requests the test of the candidate, which is the hit
  } state_e;

  state_e state_q, state_d;

  // ---- Queue of doubts

  logic queued, queued_hit;
  logic [RayWidth-1:0] queued_ctx;
  logic [AddressWidth-1:0] queued_line;

  fifo #(
    .Width(RayWidth + 1 + AddressWidth),
    .Depth(Queue),
    .Memory(1'b1)
  ) u_doubts (
    .clk_i,
    .rst_ni,
    .push_i(open_i.valid),
    .data_i({open_ctx_i, open_i.is_hit, open_i.line}),
    .space_o(),
    .pop_i(taken_o),
    .valid_o(queued),
    .data_o({queued_ctx, queued_hit, queued_line})
  );

  // ---- For each ray: whether its doubts wait, its candidate, and whether a question about it is open

  // Doubts are numbered as they come, and leave in that order. So a ray has no doubt in the queue once the ray's latest
  // doubt has left. Numbers wrap, but there are more numbers than places in the queue.
  logic [CountWidth-1:0] pushed_q, popped_q;  // doubts that came and left
  logic [CountWidth-1:0] lasts[Rays];  // number of the ray's last doubt
  logic [AddressWidth-1:0] candidates[Rays];  // line of the ray's candidate
  logic [Rays-1:0] doubtful_q, candidate_q, open_q, ready_q;
  logic [RayWidth-1:0] ready_ctx, next_ctx;
  logic settle, begin_any, done, doubt_done, is_last, keep, drop;
  logic settling_q, is_hit_q;  // the question is of settling; the doubt is certainly a hit
  logic [AddressWidth-1:0] line_q;  // line of the doubt or candidate in question

  assign busy_o  = doubtful_q | open_q | candidate_q;
  assign is_last = (state_q == StateLook) & ~settling_q & (lasts[ctx_o] == popped_q);

  rr_arbiter #(
    .Width(Rays)
  ) u_settle (
    .requests_i(ready_q & candidate_q),
    .start_i(ctx_o),
    .valid_o(settle),
    .index_o(ready_ctx)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      pushed_q    <= '0;
      popped_q    <= '0;
      doubtful_q  <= '0;
      candidate_q <= '0;
      open_q      <= '0;
      ready_q     <= '0;
    end else begin
      pushed_q <= pushed_q + CountWidth'(open_i.valid);
      popped_q <= popped_q + CountWidth'(taken_o);
      if (is_last) doubtful_q[ctx_o] <= 1'b0;
      if (open_i.valid) doubtful_q[open_ctx_i] <= 1'b1;
      if (keep) candidate_q[ctx_o] <= 1'b1;
      if (drop) candidate_q[ctx_o] <= 1'b0;
      if (begin_any) open_q[next_ctx] <= 1'b1;
      if (done) open_q[ctx_o] <= 1'b0;
      ready_q <= candidate_q & ~doubtful_q & ~open_q & idle_i;
    end
  end
  always_ff @(posedge clk_i) begin
    if (open_i.valid) lasts[open_ctx_i] <= pushed_q + 1'b1;
    if (keep) candidates[ctx_o] <= line_q;
  end

  // ---- The question

  logic has_candidate, simple, lacks_q, nearer_q;
  logic ended_q, found_q;  // known_i.ended and .found of the current ray
  logic [1:0] against, against_q;  // exact_pkg::against_e
  logic [AddressWidth-1:0] other_line_q, candidate;
  logic [CornersWidth-1:0] corners_q, other_q;
  logic [31:0] rank_q, other_rank_q;
  logic [95:0] origin, direction;
  logic fetch, line_here;
  logic [Units-1:0] unit_ready, free, unit_valid, answered, nearer;  // free, answered: one-hot
  logic [Units*AboutWidth-1:0] abouts;
  logic [AboutWidth-1:0] about;  // what the unit that has answered was asked about

  assign candidate     = candidates[ctx_o];
  assign has_candidate = candidate_q[ctx_o];

  always_comb begin
    against = exact_pkg::AgainstNothing;
    if (settling_q ? found_q : has_candidate) against = exact_pkg::AgainstOther;
    else if (settling_q && known_i.t_max != Infinity) against = exact_pkg::AgainstLimit;
  end
  // The answer is known without a question.
  assign simple = (against == exact_pkg::AgainstNothing) & (settling_q | is_hit_q);

  assign line_here = line_i.valid & line_i.exact;

  always_comb begin
    state_d = state_q;
    case (state_q)
      StateIdle:
        if (answered != '0) state_d = StateAnswer;
        else if (begin_any) state_d = StateLook;
      StateLook:  state_d = StateChoose;
      StateChoose:
        if (ended_q) state_d = StateIdle;
        else if (simple) state_d = settling_q ? StateTest : StateIdle;
        else state_d = StateFetch;
      StateFetch: if (request_ready_i) state_d = StateWait;
      StateWait:
        if (line_here) state_d = line_i.error ? StateAnswer : lacks_q ? StateFetch : StateAsk;
      StateAsk:    state_d = StateIdle;
      StateAnswer: state_d = (settling_q && nearer_q) ? StateTest : StateIdle;
      StateTest:   if (request_ready_i) state_d = StateAnswer;
      default:     state_d = StateIdle;
    endcase
  end

  assign begin_any  = (state_q == StateIdle) & (answered == '0) & (free != '0)
                    & (settle | (queued & ~open_q[queued_ctx]));
  assign next_ctx   = settle ? ready_ctx : queued_ctx;
  assign taken_o    = begin_any & ~settle;
  assign done       = ((state_q == StateChoose) & (ended_q | (simple & ~settling_q)))
                    | ((state_q == StateAnswer) & ~(settling_q & nearer_q));
  assign doubt_done = done & ~settling_q;
  assign drop       = done & settling_q;
  assign keep       = doubt_done & (((state_q == StateChoose) & ~ended_q)
                                    | ((state_q == StateAnswer) & nearer_q));

  assign fetch           = state_q == StateFetch;
  assign request_o.valid = fetch | (state_q == StateTest);
  assign request_o.exact = fetch;
  assign request_o.line  = (fetch & lacks_q) ? other_line_q : line_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) state_q <= StateIdle;
    else state_q <= state_d;
  end
  always_ff @(posedge clk_i) begin
    if (state_q == StateIdle && answered != '0) begin
      {settling_q, ctx_o, line_q} <= about;
      nearer_q <= (nearer & answered) != '0;
    end else if (begin_any) begin
      settling_q <= settle;
      ctx_o      <= next_ctx;
      is_hit_q   <= settle | queued_hit;
      line_q     <= settle ? candidates[ready_ctx] : queued_line;
    end
    // nearer_q = 0 makes StateAnswer end the question, after a line with an error and after the request of a
    // candidate's test. So line_i.error, which comes late in a clock, decides only state_q in that clock.
    if (state_q == StateWait || state_q == StateTest) nearer_q <= 1'b0;
    if (state_q == StateLook) begin
      ended_q      <= known_i.ended;
      found_q      <= known_i.found;
      other_line_q <= settling_q ? known_i.line : candidate;
    end
    if (state_q == StateChoose) begin
      against_q <= against;
      lacks_q   <= against == exact_pkg::AgainstOther;  // the other triangle's line is read first
    end
    // The cache's outputs come too late to enable so many registers: StateWait loads corners_q in each clock.
    if (state_q == StateFetch) {other_q, other_rank_q} <= {corners_q, rank_q};
    if (state_q == StateWait) begin
      corners_q <= line_i.line[TriangleCorners+:CornersWidth];
      rank_q    <= line_i.rank;
      if (line_here) lacks_q <= 1'b0;
    end
  end

  ram #(
    .Width(2 * 96),
    .Depth(Rays)
  ) u_rays (
    .clk_i,
    .write_i(load_i),
    .write_address_i(load_ctx_i),
    .data_i({load_direction_i, load_origin_i}),
    .read_i(1'b1),
    .read_address_i(ctx_o),
    .data_o({direction, origin})
  );

  // ---- Units, and what each was asked about

  assign free        = unit_ready & -unit_ready;
  assign answered    = unit_valid & -unit_valid;
  assign computing_o = unit_ready != '1;

  always_comb begin
    about = '0;
    for (int unsigned u = 0; u < Units; u++) begin
      if (answered[u]) about = abouts[AboutWidth*u+:AboutWidth];
    end
  end

  for (genvar u = 0; u < Units; u++) begin : gen_unit
    logic ask, wins_tie_q, hit;
    logic negative, nonzero;  // sign of the unit's order_o
    logic [AboutWidth-1:0] about_q;

    assign ask       = (state_q == StateAsk) & free[u];
    assign nearer[u] = hit & (negative | (~nonzero & wins_tie_q));
    assign abouts[AboutWidth*u +: AboutWidth] = about_q;

    always_ff @(posedge clk_i) begin
      if (ask) begin
        about_q    <= {settling_q, ctx_o, line_q};
        wins_tie_q <= (against_q == exact_pkg::AgainstNothing)
                    | ((against_q == exact_pkg::AgainstOther) & (rank_q < other_rank_q));
      end
    end

    exact_unit #(
      .Arith(Arith)
    ) u_unit (
      .clk_i,
      .rst_ni,
      .valid_i(ask),
      .ready_o(unit_ready[u]),
      .hit_i(~is_hit_q),
      .against_i(against_q),
      .floats_i({1'b0, known_i.t_max, other_q, corners_q, direction, origin}),
      .valid_o(unit_valid[u]),
      .ready_i((state_q == StateIdle) & answered[u]),
      .hit_o(hit),
      .order_o({negative, nonzero})
    );
  end

endmodule
