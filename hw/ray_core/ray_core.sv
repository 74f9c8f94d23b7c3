// Ray core: traces rays through a tree of boxes in memory. Rays go in; out come their nearest hits or, without Exact,
// their nearest certain hits and the tests that binary32 could not decide (doubts).
//
//   ray_alloc         reciprocals of a ray's direction, and its context    ray_retire      detects that a ray has ended
//   traversal         stacks of rays; picks a ray to visit its next node   box_unit        which children a ray enters
//   primitive_fetch   requests the triangles of leaves that a ray enters   triangle_test   hit, miss or doubt
//   closest_hit       a ray's nearest hit, t_max and doubts                exact_resolver  decides the doubts
//   memory_subsystem  the caches of nodes and triangles
//
// Rays and results: valid/ready. A ray's direction must be scaled so that its largest component is in [1, 2). Hits at
// t >= t_max (compared exactly), on triangle skip_id and on source_id, the triangle that the ray leaves, do not count.
// With any_hit a ray ends at its first certain hit. Results of different rays interleave, each with its ray's tag, and
// rays end in any order: see result_e. If a ray's end has an error, its other data are invalid: see error_e.
//
// Memory: reads of lines by number, valid/ready, each with an id; lines return with their id in any order, valid/ready.
// A line with line_error_i fails the rays that wait for it, and is read again for the next ray. As nodes are
// prefetched, outstanding_o may be high when the last ray has ended. Memory may change, and invalidate_i be high, only
// while no ray is in the core and outstanding_o is low.
//
// Throughput: a node and a triangle in Clocks clocks; if they are not in the caches, one line a clock.
module ray_core
  import ray_core_pkg::*;
#(
  parameter int unsigned Rays  = 64,  // contexts; a power of two
  parameter int unsigned Depth = 8,   // groups (see traversal) on a ray's own stack
  parameter int unsigned NodeLines     = 256,  // lines of the cache of nodes; a power of two
  parameter int unsigned TriangleLines = 256,  // lines of the cache of triangles; a power of two
  parameter int unsigned Clocks = 1,  // clocks per node and triangle: 1, or 7 or more
  parameter int unsigned Exact = 0,  // number of exact_units, which need ranks; 0: doubts leave
  parameter int unsigned Arith = arith_pkg::Graded,
  localparam int unsigned RayWidth = $clog2(Rays),
  localparam int unsigned ReadIdWidth = read_id_width(NodeLines, TriangleLines)
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    invalidate_i,  // memory has changed: see above
  output logic                    outstanding_o,
  input  logic                    abort_i,  // ends the rays in the core
  input  logic [AddressWidth-1:0] lines_i,  // number of memory's lines; 0: 2**AddressWidth
  input  logic                    ray_valid_i,
  output logic                    ray_ready_o,
  input  ray_t                    ray_i,
  output logic                    result_valid_o,
  input  logic                    result_ready_i,
  output result_t                 result_o,
  output logic                    read_valid_o,
  input  logic                    read_ready_i,
  output logic [AddressWidth-1:0] read_line_o,
  output logic [ReadIdWidth-1:0]  read_id_o,
  input  logic                    line_valid_i,
  output logic                    line_ready_o,
  input  logic [ReadIdWidth-1:0]  line_id_i,
  input  logic [LineWidth-1:0]    line_i,
  input  logic                    line_error_i,
  output logic [NumEvents-1:0]    events_o  // events of the clock before, see event_e
);

  // ---- Rays that start, and their contexts. Memories hold what is needed of a ray for nodes, triangles and tests: a
  // read with the number of its context gives these data a clock later

  logic start_valid, start_fire, ending, step;
  logic [RayWidth-1:0]
    start_ctx, ending_ctx, end_ctx, node_line_ctx, triangle_line_ctx, direction_ctx;
  logic [95:0] start_inverse, node_origin, node_inverse, triangle_origin, direction;
  logic [31:0] skip_id, source_id;
  logic [31:0] tags[Rays];
  ray_t start;

  ray_alloc #(
    .Rays(Rays),
    .Width($bits(ray_i)),
    .Clocks(Clocks),
    .Arith(Arith)
  ) u_alloc (
    .clk_i,
    .rst_ni,
    .valid_i(ray_valid_i),
    .ready_o(ray_ready_o),
    .direction_i(ray_i.direction),
    .ray_i,
    .free_valid_i(ending),
    .free_ctx_i(ending_ctx),
    .start_valid_o(start_valid),
    .start_ctx_o(start_ctx),
    .start_inverse_o(start_inverse),
    .start_ray_o(start),
    .start_fire_i(start_fire)
  );
  ram #(
    .Width(96 + 96),
    .Depth(Rays)
  ) u_node_contexts (
    .clk_i,
    .write_i(start_fire),
    .write_address_i(start_ctx),
    .data_i({start.origin, start_inverse}),
    .read_i(1'b1),
    .read_address_i(node_line_ctx),
    .data_o({node_origin, node_inverse})
  );
  ram #(
    .Width(96 + 2 * 32),
    .Depth(Rays)
  ) u_triangle_contexts (
    .clk_i,
    .write_i(start_fire),
    .write_address_i(start_ctx),
    .data_i({start.origin, start.skip_id, start.source_id}),
    .read_i(step),
    .read_address_i(triangle_line_ctx),
    .data_o({triangle_origin, skip_id, source_id})
  );
  ram #(
    .Width(96),
    .Depth(Rays)
  ) u_directions (
    .clk_i,
    .write_i(start_fire),
    .write_address_i(start_ctx),
    .data_i(start.direction),
    .read_i(step),
    .read_address_i(direction_ctx),
    .data_o(direction)
  );
  always_ff @(posedge clk_i) if (start_fire) tags[start_ctx] <= start.tag;

  // ---- Nodes

  logic [RayWidth-1:0] node_ctx, box_ctx, traversal_ctx, cycle_ctx;
  logic [30:0] traversal_t_max, box_t_max;
  logic [Rays-1:0] leaf_pending, testing, traversing, failed;
  logic traversal_ended, cycle, overflow;
  request_t node, prefetch;
  node_line_t node_line;
  boxes_t boxes;

  traversal #(
    .Rays(Rays),
    .Depth(Depth)
  ) u_traversal (
    .clk_i,
    .rst_ni,
    .start_valid_i(start_valid),
    .start_ray_i(start_ctx),
    .start_fire_o(start_fire),
    .box_valid_i(boxes.valid),
    .box_ray_i(box_ctx),
    .box_group_i(boxes.group),
    .box_inner_i(boxes.inner),
    .leaf_pending_i(leaf_pending),
    .testing_i(testing),
    .t_max_ray_o(traversal_ctx),
    .t_max_i(traversal_t_max),
    .ended_i(traversal_ended),
    .cycle_o(cycle),
    .cycle_ray_o(cycle_ctx),
    .lines_i,
    .traversing_o(traversing),
    .node_ray_o(node_ctx),
    .node_o(node),
    .prefetch_o(prefetch),
    .overflow_o(overflow)
  );
  box_unit #(
    .Rays(Rays),
    .Clocks(Clocks),
    .Arith(Arith)
  ) u_boxes (
    .clk_i,
    .rst_ni,
    .ctx_i(node_line_ctx),
    .node_i(node_line),
    .origin_i(node_origin),
    .inverse_i(node_inverse),
    .t_max_i(box_t_max),
    .ctx_o(box_ctx),
    .boxes_o(boxes)
  );

  // ---- Requests for triangles (those of exact_resolver have priority), and tests of the lines that come

  logic [RayWidth-1:0] fetch_ctx, leaf_ctx, exact_ctx, triangle_ctx, verdict_ctx;
  logic [30:0] leaf_t_max;
  logic leaf_ended, tests_allowed, triangle_ready, test;
  request_t fetch;
  triangle_request_t exact, triangle;
  triangle_line_t triangle_line;
  verdict_t verdict;

  assign triangle     = exact.valid ? exact : {fetch.valid & tests_allowed, 1'b0, fetch.line};
  assign triangle_ctx = exact.valid ? exact_ctx : fetch_ctx;
  assign test         = triangle.valid & triangle_ready & ~triangle.exact;

  primitive_fetch #(
    .Rays(Rays)
  ) u_primitives (
    .clk_i,
    .rst_ni,
    .box_valid_i(boxes.valid),
    .box_ray_i(box_ctx),
    .box_group_i(boxes.group),
    .box_leaf_i(boxes.leaf),
    .t_max_ray_o(leaf_ctx),
    .t_max_i(leaf_t_max),
    .ended_i(leaf_ended),
    .leaf_pending_o(leaf_pending),
    .triangle_ray_o(fetch_ctx),
    .triangle_o(fetch),
    .triangle_ready_i(triangle_ready & tests_allowed & ~exact.valid)
  );
  triangle_test #(
    .Rays(Rays),
    .Clocks(Clocks),
    .Arith(Arith)
  ) u_tests (
    .clk_i,
    .rst_ni,
    .step_i(step),
    .ctx_i(triangle_line_ctx),
    .triangle_i(triangle_line),
    .origin_i(triangle_origin),
    .skip_id_i(skip_id),
    .source_id_i(source_id),
    .direction_ctx_o(direction_ctx),
    .direction_i(direction),
    .ctx_o(verdict_ctx),
    .verdict_o(verdict)
  );

  // ---- Hits and doubts

  logic [RayWidth-1:0] open_ctx;
  logic [Rays-1:0] doubtful, idle;
  logic doubt_fire, doubt_taken, computing, near_tie;
  known_t known;
  logic [95:0] end_point;
  open_t open;
  doubt_t doubt;
  end_t ended;

  assign idle      = ~(traversing | leaf_pending | testing);
  assign ended.tag = tags[end_ctx];

  closest_hit #(
    .Rays(Rays),
    .Exact(Exact != 0)
  ) u_closest_hit (
    .clk_i,
    .rst_ni,
    .load_i(start_fire),
    .load_ray_i(start_ctx),
    .load_t_max_i(start.t_max),
    .load_any_hit_i(start.any_hit),
    .test_i(test),
    .test_ray_i(triangle_ctx),
    .settle_i(exact.valid),
    .tests_allowed_o(tests_allowed),
    .result_ray_i(verdict_ctx),
    .result_tag_i(tags[verdict_ctx]),
    .result_i(verdict),
    .failed_i(failed),
    .traversal_ray_i(traversal_ctx),
    .traversal_t_max_o(traversal_t_max),
    .traversal_ended_o(traversal_ended),
    .leaf_ray_i(leaf_ctx),
    .leaf_t_max_o(leaf_t_max),
    .leaf_ended_o(leaf_ended),
    .box_ray_i(node_line_ctx),
    .box_t_max_o(box_t_max),
    .testing_o(testing),
    .exact_ray_i(exact_ctx),
    .exact_o(known),
    .doubt_o(doubt),
    .doubt_fire_i(doubt_fire | doubt_taken),
    .open_ray_o(open_ctx),
    .open_o(open),
    .end_ray_i(end_ctx),
    .end_o(ended.hit),
    .point_ray_i(ending_ctx),
    .point_o(end_point),
    .near_tie_o(near_tie)
  );

  if (Exact != 0) begin : gen_exact
    exact_resolver #(
      .Rays(Rays),
      .Units(Exact),
      .Arith(Arith)
    ) u_resolver (
      .clk_i,
      .rst_ni,
      .load_i(start_fire),
      .load_ctx_i(start_ctx),
      .load_origin_i(start.origin),
      .load_direction_i(start.direction),
      .open_ctx_i(open_ctx),
      .open_i(open),
      .taken_o(doubt_taken),
      .idle_i(idle),
      .busy_o(doubtful),
      .ctx_o(exact_ctx),
      .known_i(known),
      .request_o(exact),
      .request_ready_i(triangle_ready),
      .line_i(triangle_line),
      .computing_o(computing)
    );
  end else begin : gen_doubts
    logic unused_exact;
    assign {doubt_taken, doubtful, exact, exact_ctx, computing} = '0;
    assign unused_exact = ^{known, open_ctx, open, triangle_line.rank};
  end

  ray_retire #(
    .Rays(Rays)
  ) u_retire (
    .clk_i,
    .rst_ni,
    .start_i(start_fire),
    .start_ctx_i(start_ctx),
    .busy_i(~idle | doubtful),
    .ending_o(ending),
    .ending_ctx_o(ending_ctx),
    .end_ctx_o(end_ctx),
    .end_i(ended),
    .point_i(end_point),
    .doubt_i(doubt),
    .doubt_fire_o(doubt_fire),
    .result_valid_o,
    .result_ready_i,
    .result_o
  );

  // ---- Errors: the first error of each ray. A ray counts as failed from two clocks after its error (its end is not
  // reported earlier) until another ray starts in its context. While abort_i is high, all rays in the core fail.

  logic [Rays-1:0][2:0] errors_q;
  logic node_error_q, triangle_error_q, cycle_q;
  logic [RayWidth-1:0] node_error_ctx_q, triangle_error_ctx_q, cycle_ctx_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) {node_error_q, triangle_error_q, cycle_q} <= '0;
    else begin
      node_error_q     <= node_line.valid & node_line.error;
      triangle_error_q <= triangle_line.valid & triangle_line.error;
      cycle_q          <= cycle;
    end
  end
  always_ff @(posedge clk_i) begin
    node_error_ctx_q     <= node_line_ctx;
    triangle_error_ctx_q <= triangle_line_ctx;
    cycle_ctx_q          <= cycle_ctx;
  end

  for (genvar r = 0; r < Rays; r++) begin : gen_error
    logic [2:0] error_d;

    assign failed[r] = errors_q[r] != ErrorNone;

    always_comb begin
      error_d = errors_q[r];
      if (!failed[r]) begin
        if (cycle_q && cycle_ctx_q == RayWidth'(r)) error_d = ErrorCycle;
        if ((node_error_q && node_error_ctx_q == RayWidth'(r))
            || (triangle_error_q && triangle_error_ctx_q == RayWidth'(r))) begin
          error_d = ErrorMemory;
        end
        if (abort_i) error_d = ErrorAbort;
      end
      if (start_fire && start_ctx == RayWidth'(r)) begin
        error_d = !is_scaled(start.direction) ? ErrorDirection : abort_i ? ErrorAbort : ErrorNone;
      end
    end
    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) errors_q[r] <= ErrorNone;
      else errors_q[r] <= error_d;
    end
  end

  assign ended.error = errors_q[end_ctx];

  // ---- Memory

  memory_subsystem #(
    .Rays(Rays),
    .NodeLines(NodeLines),
    .TriangleLines(TriangleLines),
    .Exact(Exact != 0),
    .Clocks(Clocks)
  ) u_memory (
    .clk_i,
    .rst_ni,
    .invalidate_i,
    .outstanding_o,
    .node_ctx_i(node_ctx),
    .node_i(node),
    .prefetch_i(prefetch),
    .triangle_ctx_i(triangle_ctx),
    .triangle_i(triangle),
    .triangle_ready_o(triangle_ready),
    .read_valid_o,
    .read_ready_i,
    .read_line_o,
    .read_id_o,
    .line_valid_i,
    .line_ready_o,
    .line_id_i,
    .line_i,
    .line_error_i,
    .step_o(step),
    .node_ctx_o(node_line_ctx),
    .node_o(node_line),
    .triangle_ctx_o(triangle_line_ctx),
    .triangle_o(triangle_line)
  );

  // ---- Events

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) events_o <= '0;
    else begin
      events_o[EventRay]      <= ending;
      events_o[EventNode]     <= node_line.valid;
      events_o[EventTriangle] <= triangle_line.valid & ~triangle_line.exact;
      events_o[EventHit]      <= verdict.valid & verdict.found & ~verdict.is_skipped;
      events_o[EventMiss]     <= verdict.valid
          & (verdict.is_skipped | (~verdict.found & ~verdict.doubt));
      events_o[EventDoubt]    <= verdict.valid & verdict.doubt & ~verdict.is_skipped;
      events_o[EventNearTie]  <= near_tie;
      events_o[EventOverflow] <= overflow;
      events_o[EventRead]     <= read_valid_o & read_ready_i;
      events_o[EventWait]     <= read_valid_o & ~read_ready_i;
      events_o[EventExact]    <= computing;
    end
  end

endmodule
