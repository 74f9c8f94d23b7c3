// Ray core: rays in, nearest sure hits and doubts out; it traverses a tree of boxes in memory by itself.
//
//   ray_context        the rays in flight; ray_alloc gives each its context, and 1 / I_k
//   traversal          the stacks, and which ray goes to its next node
//   memory_subsystem   nodes and triangles, from caches or memory
//   box_pipeline       box_unit: which children of a node a ray enters
//   primitive_fetch    the triangles of the leaves among them
//   triangle_test      set_up_unit: a triangle's record, seen from the ray's origin; hit_test_pipeline: hit,
//                      miss or doubt, t, P
//   closest_hit        each ray's nearest hit and t_max, and the doubts
//   ray_errors         why a ray's hits must not be believed
//   ray_retire         which rays have ended; results
//
// Rays and results: valid/ready. A ray begins at the inner node of line `start` (the root's, as a
// rule). Its direction is scaled: the largest component is in [1, 2). Hits at t >= `t_max`, in exact
// arithmetic, and on triangle `skip_id` do not count. With `any_hit` it ends at its first sure hit,
// with `no_cull` it enters all boxes. Words about rays come mixed, and rays end in any order; by tag:
//   ResultDoubt  a triangle that may be hit, and be the nearest: exact arithmetic must say
//   ResultOverflow  subtrees for which the stack had no room: bit i of `nodes` is the inner node at
//                line `line` + i. The ray must be sent there, too
//   ResultEnd    the ray's last word: whether it has a sure hit, of which triangle, at which t (off by fewer
//                than 2**t_error numbers), P as the pipeline has it, and how many tests there were. With a
//                error its words say nothing: it was given up at once, see ray_core_pkg::error_e
//
// Memory: reads of lines by number, valid/ready, each with an id. Lines come back with it, in any order,
// valid/ready; with line_error_i, not to be believed: it is read again for the next ray. Some are prefetched: outstanding_o may be high when the last ray has
// ended. Memory may change, and invalidate_i be high then, while no ray is here and outstanding_o is low.
//
// Throughput: a node and a triangle a clock, out of the caches; a line a clock of what they lack.
module ray_core #(
  parameter int unsigned Rays  = 64,  // of the table; a power of two
  parameter int unsigned Depth = 8,   // groups on a ray's stack
  parameter int unsigned NodeLines     = 256,  // of the cache of nodes; a power of two
  parameter int unsigned TriangleLines = 256,  // of the cache of triangles; likewise
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned RayWidth = $clog2(Rays),
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth,
  localparam int unsigned ReadIdWidth = 1 + $clog2(
      NodeLines > TriangleLines ? NodeLines : TriangleLines),
  localparam int unsigned LineWidth = ray_core_pkg::LineWidth
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    invalidate_i,  // memory has changed: see above
  output logic                    outstanding_o,
  input  logic                    abort_i,  // the rays that are here
  input  logic [AddressWidth-1:0] lines_i,  // of memory; 0: 2**AddressWidth
  // rays
  input  logic                    ray_valid_i,
  output logic                    ray_ready_o,
  input  ray_core_pkg::ray_t        ray_i,
  // results
  output logic                    result_valid_o,
  input  logic                    result_ready_i,
  output ray_core_pkg::result_t    result_o,
  // memory
  output logic                    read_valid_o,
  input  logic                    read_ready_i,
  output logic [AddressWidth-1:0] read_line_o,
  output logic [ReadIdWidth-1:0]  read_id_o,
  input  logic                    line_valid_i,
  output logic                    line_ready_o,
  input  logic [ReadIdWidth-1:0]  line_id_i,
  input  logic [LineWidth-1:0]    line_i,
  input  logic                    line_error_i,
  output logic [ray_core_pkg::NumEvents-1:0] events_o  // of the clock before, see event_e
);

  localparam int unsigned GroupWidth = ray_core_pkg::GroupWidth;
  localparam int unsigned Children = ray_core_pkg::Children;
  localparam int unsigned PlaneErrorWidth = set_up_pkg::PlaneErrorWidth;

  if (ray_core_pkg::TErrorWidth != set_up_pkg::TErrorExponentWidth) begin : gen_check
    $error("ray_core: TErrorWidth of ray_core_pkg is not set_up_pkg's");
  end

  // ---- Contexts

  logic start_valid, start_fire, ending, node_no_cull;
  logic [RayWidth-1:0]
    start_ctx, ending_ctx, node_line_ray, box_ray, triangle_line_ray, set_ray, result_ray;
  logic [31:0] ending_tag, box_tag, result_tag, skip_id;
  logic [95:0] node_origin, node_inverse, triangle_origin, direction;
  logic [30:0] start_t_max;
  logic [AddressWidth-1:0] start_line;
  logic start_any_hit, start_scaled;

  ray_context #(
    .Rays(Rays),
    .Arith(Arith),
    .Adder(Adder)
  ) u_contexts (
    .clk_i,
    .rst_ni,
    .valid_i(ray_valid_i),
    .ready_o(ray_ready_o),
    .ray_i,
    .start_valid_o(start_valid),
    .start_ctx_o(start_ctx),
    .start_t_max_o(start_t_max),
    .start_line_o(start_line),
    .start_any_hit_o(start_any_hit),
    .start_scaled_o(start_scaled),
    .start_fire_i(start_fire),
    .ending_i(ending),
    .ending_ctx_i(ending_ctx),
    .ending_tag_o(ending_tag),
    .node_ctx_i(node_line_ray),
    .node_origin_o(node_origin),
    .node_inverse_o(node_inverse),
    .node_no_cull_o(node_no_cull),
    .box_ctx_i(box_ray),
    .box_tag_o(box_tag),
    .triangle_ctx_i(triangle_line_ray),
    .triangle_origin_o(triangle_origin),
    .triangle_skip_id_o(skip_id),
    .direction_ctx_i(set_ray),
    .direction_o(direction),
    .result_ctx_i(result_ray),
    .result_tag_o(result_tag)
  );

  // ---- Traversal

  logic box_valid, traversal_ended, leaf_ended, leaf_counter_full, node, prefetch;
  logic overflow_valid, overflow_fire, cycle;
  logic [RayWidth-1:0] traversal_ray, leaf_ray, node_ray;
  logic [31:0] overflow_tag;
  logic [GroupWidth-1:0] box_group;
  logic [Children-1:0] box_inner, box_leaf;
  logic [30:0] traversal_t_max, leaf_t_max;
  logic [Rays-1:0] leaf_pending, testing, traversing, failed;
  logic [AddressWidth-1:0] node_line, prefetch_line, overflow_line;
  logic [ray_core_pkg::NodesWidth-1:0] overflow_nodes;

  traversal #(
    .Rays(Rays),
    .Depth(Depth)
  ) u_traversal (
    .clk_i,
    .rst_ni,
    .start_valid_i(start_valid),
    .start_ray_i(start_ctx),
    .start_line_i(start_line),
    .start_fire_o(start_fire),
    .box_valid_i(box_valid),
    .box_ray_i(box_ray),
    .box_tag_i(box_tag),
    .box_group_i(box_group),
    .box_inner_i(box_inner),
    .leaf_pending_i(leaf_pending),
    .testing_i(testing),
    .t_max_ray_o(traversal_ray),
    .t_max_i(traversal_t_max),
    .ended_i(traversal_ended | failed[traversal_ray]),
    .cycle_o(cycle),
    .lines_i,
    .traversing_o(traversing),
    .node_valid_o(node),
    .node_ray_o(node_ray),
    .node_line_o(node_line),
    .prefetch_o(prefetch),
    .prefetch_line_o(prefetch_line),
    .overflow_valid_o(overflow_valid),
    .overflow_tag_o(overflow_tag),
    .overflow_line_o(overflow_line),
    .overflow_nodes_o(overflow_nodes),
    .overflow_fire_i(overflow_fire)
  );

  logic triangle_valid, triangle_ready;
  logic [RayWidth-1:0] triangle_ray;
  logic [AddressWidth-1:0] triangle_line;

  primitive_fetch #(
    .Rays(Rays)
  ) u_primitives (
    .clk_i,
    .rst_ni,
    .box_valid_i(box_valid),
    .box_ray_i(box_ray),
    .box_group_i(box_group),
    .box_leaf_i(box_leaf),
    .t_max_ray_o(leaf_ray),
    .t_max_i(leaf_t_max),
    .ended_i(leaf_ended | failed[leaf_ray]),
    .counter_full_i(leaf_counter_full),
    .leaf_pending_o(leaf_pending),
    .triangle_valid_o(triangle_valid),
    .triangle_ready_i(triangle_ready),
    .triangle_ray_o(triangle_ray),
    .triangle_line_o(triangle_line)
  );

  // ---- Memory

  logic node_here, node_error, triangle_here, triangle_error, tests_allowed;
  logic [LineWidth-1:0] node_words;
  logic [ray_core_pkg::TriangleWidth-1:0] triangle_words;

  memory_subsystem #(
    .Rays(Rays),
    .NodeLines(NodeLines),
    .TriangleLines(TriangleLines)
  ) u_memory (
    .clk_i,
    .rst_ni,
    .invalidate_i,
    .outstanding_o,
    .node_i(node),
    .node_ray_i(node_ray),
    .node_line_i(node_line),
    .prefetch_i(prefetch),
    .prefetch_line_i(prefetch_line),
    .triangle_i(triangle_valid),
    .triangle_ready_o(triangle_ready),
    .triangle_ray_i(triangle_ray),
    .triangle_line_i(triangle_line),
    .read_valid_o,
    .read_ready_i,
    .read_line_o,
    .read_id_o,
    .line_valid_i,
    .line_ready_o,
    .line_id_i,
    .line_i,
    .line_error_i,
    .tests_allowed_i(tests_allowed),
    .node_valid_o(node_here),
    .node_ray_o(node_line_ray),
    .node_o(node_words),
    .node_error_o(node_error),
    .triangle_valid_o(triangle_here),
    .triangle_ray_o(triangle_line_ray),
    .triangle_o(triangle_words),
    .triangle_error_o(triangle_error)
  );

  // ---- Boxes

  logic [30:0] box_t_max;

  box_pipeline #(
    .Rays(Rays),
    .Arith(Arith),
    .Adder(Adder)
  ) u_boxes (
    .clk_i,
    .rst_ni,
    .valid_i(node_here),
    .ctx_i(node_line_ray),
    .node_i(node_words),
    .origin_i(node_origin),
    .inverse_i(node_inverse),
    .t_max_i(box_t_max),
    .no_cull_i(node_no_cull),
    .valid_o(box_valid),
    .ctx_o(box_ray),
    .group_o(box_group),
    .inner_o(box_inner),
    .leaf_o(box_leaf)
  );

  // ---- Tests

  logic over, found, doubt, point_valid, result_skipped;
  logic [31:0] t, result_triangle;
  logic [hit_test_pkg::TErrorWidth-1:0] t_error;
  logic [PlaneErrorWidth-1:0] normal_error, distance_error;
  logic [95:0] point;

  triangle_test #(
    .Rays(Rays),
    .Arith(Arith),
    .Adder(Adder)
  ) u_tests (
    .clk_i,
    .rst_ni,
    .valid_i(triangle_here),
    .ctx_i(triangle_line_ray),
    .triangle_i(triangle_words),
    .origin_i(triangle_origin),
    .skip_id_i(skip_id),
    .error_i(triangle_error),
    .direction_ctx_o(set_ray),
    .direction_i(direction),
    .closed_o(over),
    .ctx_o(result_ray),
    .triangle_o(result_triangle),
    .is_skipped_o(result_skipped),
    .doubt_o(doubt),
    .found_o(found),
    .t_o(t),
    .t_error_o(t_error),
    .normal_error_o(normal_error),
    .distance_error_o(distance_error),
    .point_valid_o(point_valid),
    .point_o(point)
  );

  // ---- Hits

  logic near_tie, doubt_valid, doubt_fire;
  logic [31:0] doubt_tag, doubt_triangle, end_triangle, end_t;
  logic [ray_core_pkg::TErrorWidth-1:0] end_t_error;
  logic [ray_core_pkg::TestsWidth-1:0] end_tests;
  logic end_found;
  logic [RayWidth-1:0] point_ctx;
  logic [95:0] end_point;

  // From the clock in which a triangle line leaves memory to that in which its test is over, one more for tests_allowed
  localparam int unsigned InFlight = set_up_pkg::Latency + hit_test_pkg::DotLatency
                                   + hit_test_pkg::divide_latency(
    23
  ) + 7;

  closest_hit #(
    .Rays(Rays),
    .InFlight(InFlight)
  ) u_closest_hit (
    .clk_i,
    .rst_ni,
    .load_i(start_fire),
    .load_ray_i(start_ctx),
    .load_t_max_i(start_t_max),
    .load_any_hit_i(start_any_hit),
    .test_i(triangle_valid & triangle_ready),
    .test_ray_i(triangle_ray),
    .tests_allowed_o(tests_allowed),
    .result_i(over),
    .result_ray_i(result_ray),
    .result_tag_i(result_tag),
    .result_triangle_i(result_triangle),
    .result_skipped_i(result_skipped),
    .result_doubt_i(doubt),
    .result_hit_i(found),
    .result_t_i(t),
    .result_t_error_i(t_error),
    .result_normal_error_i(normal_error),
    .result_distance_error_i(distance_error),
    .point_valid_i(point_valid),
    .point_i(point),
    .traversal_ray_i(traversal_ray),
    .traversal_t_max_o(traversal_t_max),
    .traversal_ended_o(traversal_ended),
    .leaf_ray_i(leaf_ray),
    .leaf_t_max_o(leaf_t_max),
    .leaf_ended_o(leaf_ended),
    .leaf_counter_full_o(leaf_counter_full),
    .box_ray_i(node_line_ray),
    .box_t_max_o(box_t_max),
    .testing_o(testing),
    .doubt_valid_o(doubt_valid),
    .doubt_tag_o(doubt_tag),
    .doubt_triangle_o(doubt_triangle),
    .doubt_fire_i(doubt_fire),
    .end_ray_i(ending_ctx),
    .end_found_o(end_found),
    .end_triangle_o(end_triangle),
    .end_t_o(end_t),
    .end_t_error_o(end_t_error),
    .end_tests_o(end_tests),
    .point_ray_i(point_ctx),
    .point_o(end_point),
    .near_tie_o(near_tie)
  );

  // ---- Errors

  logic [2:0] ending_error;

  ray_errors #(
    .Rays(Rays)
  ) u_errors (
    .clk_i,
    .rst_ni,
    .abort_i,
    .start_i(start_fire),
    .start_ctx_i(start_ctx),
    .start_scaled_i(start_scaled),
    .node_i(node_here & node_error),
    .node_ctx_i(node_line_ray),
    .triangle_i(triangle_here & triangle_error),
    .triangle_ctx_i(triangle_line_ray),
    .cycle_i(cycle),
    .cycle_ctx_i(traversal_ray),
    .failed_o(failed),
    .ending_ctx_i(ending_ctx),
    .ending_error_o(ending_error)
  );

  // ---- Results

  ray_retire #(
    .Rays(Rays)
  ) u_retire (
    .clk_i,
    .rst_ni,
    .start_i(start_fire),
    .start_ctx_i(start_ctx),
    .busy_i(traversing | leaf_pending | testing),
    .ending_o(ending),
    .ending_ctx_o(ending_ctx),
    .ending_tag_i(ending_tag),
    .ending_found_i(end_found),
    .ending_triangle_i(end_triangle),
    .ending_t_i(end_t),
    .ending_t_error_i(end_t_error),
    .ending_tests_i(end_tests),
    .ending_error_i(ending_error),
    .point_ctx_o(point_ctx),
    .point_i(end_point),
    .doubt_valid_i(doubt_valid),
    .doubt_tag_i(doubt_tag),
    .doubt_triangle_i(doubt_triangle),
    .doubt_fire_o(doubt_fire),
    .overflow_valid_i(overflow_valid),
    .overflow_tag_i(overflow_tag),
    .overflow_line_i(overflow_line),
    .overflow_nodes_i(overflow_nodes),
    .overflow_fire_o(overflow_fire),
    .result_valid_o,
    .result_ready_i,
    .result_o
  );

  // ---- Events

  logic [ray_core_pkg::NumEvents-1:0] events;

  always_comb begin
    events = '0;
    events[ray_core_pkg::EventRay]      = ending;
    events[ray_core_pkg::EventNode]     = node_here;
    events[ray_core_pkg::EventTriangle] = triangle_here;
    events[ray_core_pkg::EventHit]      = over & found;
    events[ray_core_pkg::EventMiss]     = over & ~found & ~doubt;
    events[ray_core_pkg::EventDoubt]    = over & doubt;
    events[ray_core_pkg::EventNearTie]  = near_tie;
    events[ray_core_pkg::EventOverflow] = overflow_fire;
    events[ray_core_pkg::EventRead]     = read_valid_o & read_ready_i;
    events[ray_core_pkg::EventWait]     = read_valid_o & ~read_ready_i;
  end
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) events_o <= '0;
    else events_o <= events;
  end

endmodule
