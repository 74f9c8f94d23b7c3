// Claims, from reset on, whatever a ray core does for its rays and however long it takes: A context belongs to one ray
// at a time. No ray ends that is not in the core. Each ray is in one place: queue of rays, context, way into the queue
// of ends, this queue, or result port. Per ray, one end result leaves the core. No queue overflows. One arbitrary ray
// is marked; its end result leaves once and has the mark. Its P is then that of the ray's end, because a queue keeps P
// and mark in one word. opened_ray_contexts is contracts/ray_contexts.sv with its registers as outputs.
module contexts_answer_once #(
  parameter int unsigned Rays = 4,
  localparam int unsigned CtxWidth = $clog2(Rays)
) (
  input logic            clk,
  input logic            ray,    // a ray is offered
  input logic            choose,  // the offered ray is the marked one
  input logic            begin_walk,
  input logic [Rays-1:0] busy,
  input logic            doubt,
  input logic            take    // ready for results
);

  localparam int unsigned Divide = hit_test_pkg::divide_latency(23);
  localparam int unsigned InDepth = Divide + 3;
  localparam int unsigned EndDepth = 8;
  localparam int unsigned InCountWidth = $clog2(InDepth + 1);
  localparam int unsigned EndCountWidth = $clog2(EndDepth + 1);
  localparam int unsigned TotalWidth = 8;

  logic reset_n;  // low for the first clock
  initial reset_n = 1'b0;
  always_ff @(posedge clk) reset_n <= 1'b1;

  logic ready, started, ending, valid;
  logic chosen, left;  // chosen: a ray was marked; left: its end result has left
  logic kind;
  logic [CtxWidth-1:0] started_ctx, ending_ctx;
  logic [Rays-1:0] free_q, active_q;
  logic [Divide-1:0] dividing_q;
  logic known_q;
  logic [InCountWidth-1:0] rays_count, inverses_count;
  logic [EndCountWidth-1:0] ends_count;
  logic [InDepth-1:0] ray_marks;
  logic [EndDepth-1:0] end_marks;
  logic [Rays-1:0] marks;
  logic entering, answer_mark;
  logic rays_valid, inverses_valid, ends_valid, rays_space, ends_space;

  opened_ray_contexts dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .ray_valid_i(ray),
    .ray_ready_o(ready),
    .ray_mark_i(choose && !chosen),
    .start_i(begin_walk),
    .busy_i(busy),
    .started_o(started),
    .started_ctx_o(started_ctx),
    .ending_o(ending),
    .ending_ctx_o(ending_ctx),
    .marks_o(marks),
    .entering_o(entering),
    .doubt_valid_i(doubt),
    .result_valid_o(valid),
    .result_ready_i(take),
    .result_kind_o(kind),
    .result_mark_o(answer_mark),
    .\u_alloc.u_rays.bits_q (ray_marks),
    .\u_retire.u_ends.bits_q (end_marks),
    .\u_alloc.free_q (free_q),
    .\u_alloc.dividing_q (dividing_q),
    .\u_alloc.u_rays.count_q (rays_count),
    .\u_alloc.u_rays.valid_o (rays_valid),
    .\u_alloc.u_rays.space_o (rays_space),
    .\u_alloc.u_inverses.count_q (inverses_count),
    .\u_alloc.u_inverses.valid_o (inverses_valid),
    .\u_retire.active_q (active_q),
    .\u_retire.known_q (known_q),
    .\u_retire.u_ends.count_q (ends_count),
    .\u_retire.u_ends.valid_o (ends_valid),
    .\u_retire.u_ends.space_o (ends_space)
  );

  function automatic logic [TotalWidth-1:0] ones(logic [31:0] word);
    ones = '0;
    for (int unsigned i = 0; i < 32; i++) ones = ones + TotalWidth'(word[i]);
  endfunction

  initial {chosen, left} = '0;

  // ---- What the user sees: rays accepted, and end results delivered

  logic ended, end_offered, offered;  // offered: the marked ray's end result is at the port
  assign offered  = end_offered && answer_mark;
  logic [TotalWidth-1:0] in_flight;  // number of rays accepted without an end result delivered
  logic [Rays-1:0] used;          // contexts with a ray that has started and not ended
  assign ended       = valid && take && kind == ray_core_pkg::ResultEnd;
  assign end_offered = valid && kind == ray_core_pkg::ResultEnd;

  always_ff @(posedge clk) begin
    if (!reset_n) begin
      in_flight <= '0;
      used <= '0;
      {chosen, left} <= '0;
    end else begin
      if (ray && ready && choose) chosen <= 1'b1;
      if (ended && answer_mark) left <= 1'b1;
      in_flight <= in_flight + TotalWidth'(ray && ready) - TotalWidth'(ended);
      if (started) used[started_ctx] <= 1'b1;
      if (ending) used[ending_ctx] <= 1'b0;
    end
  end

  always_comb begin
    if (reset_n) begin
      if (started) assert (!used[started_ctx]);
      if (ending) assert (used[ending_ctx] && !busy[ending_ctx]);
      if (ended) assert (in_flight != '0);
      assert (in_flight == TotalWidth'(rays_count) + ones(32'(used)) + TotalWidth'(known_q)
                        + TotalWidth'(ends_count) + TotalWidth'(end_offered));
      assert (rays_count <= InCountWidth'(InDepth));
      assert (TotalWidth'(ends_count) + TotalWidth'(known_q) <= TotalWidth'(EndDepth));

      if (ended && answer_mark) assert (chosen && !left);

      // Invariant: the marked ray is in exactly one of the places listed above, or has left
      assert (TotalWidth'(chosen) == ones(32'(ray_marks)) + ones(32'(marks)) + TotalWidth'(entering)
                                     + ones(32'(end_marks)) + TotalWidth'(offered) + TotalWidth'(left));
      assert (ray_marks >> rays_count == '0 && end_marks >> ends_count == '0);
      assert ((marks & ~used) == '0);
      if (entering) assert (known_q);

      // Invariants
      assert (free_q == ~used && active_q == used);
      assert (TotalWidth'(rays_count) == TotalWidth'(inverses_count) + ones(32'(dividing_q)));
      assert (inverses_valid == (inverses_count != '0));
      // A queue in a memory has a latency of one clock: a single word may not be at the output yet
      if (rays_count != InCountWidth'(dividing_q[0])) assert (rays_valid);
      if (ends_count > EndCountWidth'(1)) assert (ends_valid);
      if (rays_valid) assert (rays_count != '0);
      if (ends_valid) assert (ends_count != '0);
      assert (rays_space == (rays_count < InCountWidth'(InDepth)));
      assert (ends_space == (ends_count < EndCountWidth'(EndDepth - 1)));

      cover (ended && answer_mark);
    end
  end

endmodule
