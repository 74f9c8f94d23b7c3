// The ray core: rays in, nearest sure hits and doubts out; it walks the tree of boxes in memory by itself.
//
//   ray_table          rays by their slots: ray_intake gives each its slot, and 1 / I_k
//   ray_walk           the stacks, and which ray goes to its next node
//   line_port          nodes and triangles, from caches or memory
//   box_test           box_unit: which children of a node a ray enters
//   leaf_walk          the triangles of the leaves among them
//   triangle_test      set_up_unit: a triangle's record, seen from the ray's origin; hit_test_pipeline: hit,
//                      miss or doubt, t, P
//   ray_hits           each ray's nearest hit and limit, and the doubts
//   ray_ends           which rays have ended; results
//
// Rays and results: valid/ready. A ray's walk begins at the inner node of line ray_start_i (the root's, as a
// rule). Its direction is scaled: the largest component is in [1, 2). Hits at t >= ray_limit_i, in exact
// arithmetic, and on triangle ray_ignored_i do not count. With ray_any_hit_i it ends at its first sure hit,
// with ray_every_box_i it enters all boxes. Words about rays come mixed, and rays end in any order; by tag:
//   ResultDoubt  a triangle that may be hit, and be the nearest: exact arithmetic must say
//   ResultRest   subtrees that the stack had no room for: bit i of result_nodes_o is the inner node at line
//                result_line_o + i. The ray must be sent there, too
//   ResultEnd    the ray's last word: whether it has a sure hit, of which triangle, at which t (off by fewer
//                than 2**result_t_error_o numbers), P as the pipeline has it, and how many tests there were
//
// Memory: reads of lines by number, valid/ready, each with a tag. Lines come back with it, in any order,
// valid/ready. Some are asked for because they may be needed soon: reading_o may be high when the last ray has
// ended. Memory may change, and invalidate_i be high then, while no ray is here and reading_o is low.
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
  localparam int unsigned TagWidth = 1 + $clog2(
      NodeLines > TriangleLines ? NodeLines : TriangleLines),
  localparam int unsigned LineWidth = ray_core_pkg::LineWidth,
  localparam int unsigned NodesWidth = ray_core_pkg::NodesWidth,
  localparam int unsigned TestsWidth = ray_core_pkg::TestsWidth,
  localparam int unsigned TErrorWidth = set_up_pkg::TErrorExponentWidth
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    invalidate_i,  // memory has changed: see above
  output logic                    reading_o,
  // rays
  input  logic                    ray_valid_i,
  output logic                    ray_ready_o,
  input  logic [95:0]             ray_origin_i,  // binary32, x lowest
  input  logic [95:0]             ray_direction_i,
  input  logic [30:0]             ray_limit_i,  // positive, without its sign; infinity for none
  input  logic [31:0]             ray_ignored_i,
  input  logic [AddressWidth-1:0] ray_start_i,
  input  logic                    ray_any_hit_i,
  input  logic                    ray_every_box_i,
  input  logic [31:0]             ray_tag_i,
  // results
  output logic                    result_valid_o,
  input  logic                    result_ready_i,
  output ray_core_pkg::result_e   result_kind_o,
  output logic [31:0]             result_tag_o,
  output logic                    result_found_o,
  output logic [31:0]             result_triangle_o,
  output logic [31:0]             result_t_o,
  output logic [TErrorWidth-1:0]  result_t_error_o,
  output logic [95:0]             result_point_o,
  output logic [TestsWidth-1:0]   result_tests_o,
  output logic [AddressWidth-1:0] result_line_o,
  output logic [NodesWidth-1:0]   result_nodes_o,
  // memory
  output logic                    read_valid_o,
  input  logic                    read_ready_i,
  output logic [AddressWidth-1:0] read_line_o,
  output logic [TagWidth-1:0]     read_tag_o,
  input  logic                    line_valid_i,
  output logic                    line_ready_o,
  input  logic [TagWidth-1:0]     line_tag_i,
  input  logic [LineWidth-1:0]    line_i,
  output logic [ray_core_pkg::NumEvents-1:0] events_o  // of the clock before, see event_e
);

  localparam int unsigned GroupWidth = ray_core_pkg::GroupWidth;
  localparam int unsigned Children = ray_core_pkg::Children;
  localparam int unsigned PlaneErrorWidth = set_up_pkg::PlaneErrorWidth;

  // ---- The table

  logic start_valid, start_taken, ending, node_every_box;
  logic [RayWidth-1:0]
    slot, ending_slot, node_line_ray, box_ray, triangle_line_ray, set_ray, result_ray;
  logic [31:0] ending_tag, box_tag, result_tag, ignored;
  logic [95:0] node_origin, node_inverse, triangle_origin, direction;
  ray_core_pkg::ray_t ray;
  logic [30:0] start_limit;
  logic [AddressWidth-1:0] start_line;
  logic start_any_hit;

  assign ray = {
    ray_origin_i,
    ray_direction_i,
    ray_limit_i,
    ray_ignored_i,
    ray_start_i,
    ray_any_hit_i,
    ray_every_box_i,
    ray_tag_i
  };

  ray_table #(
    .Rays(Rays),
    .Arith(Arith),
    .Adder(Adder)
  ) u_table (
    .clk_i,
    .rst_ni,
    .valid_i(ray_valid_i),
    .ready_o(ray_ready_o),
    .ray_i(ray),
    .start_valid_o(start_valid),
    .start_slot_o(slot),
    .start_limit_o(start_limit),
    .start_line_o(start_line),
    .start_any_hit_o(start_any_hit),
    .start_taken_i(start_taken),
    .ending_i(ending),
    .ending_slot_i(ending_slot),
    .ending_tag_o(ending_tag),
    .node_slot_i(node_line_ray),
    .node_origin_o(node_origin),
    .node_inverse_o(node_inverse),
    .node_every_box_o(node_every_box),
    .box_slot_i(box_ray),
    .box_tag_o(box_tag),
    .triangle_slot_i(triangle_line_ray),
    .triangle_origin_o(triangle_origin),
    .triangle_ignored_o(ignored),
    .direction_slot_i(set_ray),
    .direction_o(direction),
    .result_slot_i(result_ray),
    .result_tag_o(result_tag)
  );

  // ---- Walk

  logic box_valid, walk_ended, leaf_ended, leaf_crowded, node, soon, rest_valid, rest_taken;
  logic [RayWidth-1:0] walk_ray, leaf_ray, node_ray;
  logic [31:0] rest_tag;
  logic [GroupWidth-1:0] box_group;
  logic [Children-1:0] box_inner, box_leaf;
  logic [30:0] walk_limit, leaf_limit;
  logic [Rays-1:0] held, testing, walking;
  logic [AddressWidth-1:0] node_line, soon_line, rest_line;
  logic [NodesWidth-1:0] rest_nodes;

  ray_walk #(
    .Rays(Rays),
    .Depth(Depth)
  ) u_walk (
    .clk_i,
    .rst_ni,
    .start_valid_i(start_valid),
    .start_ray_i(slot),
    .start_line_i(start_line),
    .start_taken_o(start_taken),
    .box_valid_i(box_valid),
    .box_ray_i(box_ray),
    .box_tag_i(box_tag),
    .box_group_i(box_group),
    .box_inner_i(box_inner),
    .held_i(held),
    .testing_i(testing),
    .limit_ray_o(walk_ray),
    .limit_i(walk_limit),
    .ended_i(walk_ended),
    .walking_o(walking),
    .node_valid_o(node),
    .node_ray_o(node_ray),
    .node_line_o(node_line),
    .soon_o(soon),
    .soon_line_o(soon_line),
    .rest_valid_o(rest_valid),
    .rest_tag_o(rest_tag),
    .rest_line_o(rest_line),
    .rest_nodes_o(rest_nodes),
    .rest_taken_i(rest_taken)
  );

  logic triangle_valid, triangle_ready;
  logic [RayWidth-1:0] triangle_ray;
  logic [AddressWidth-1:0] triangle_line;

  leaf_walk #(
    .Rays(Rays)
  ) u_leaves (
    .clk_i,
    .rst_ni,
    .box_valid_i(box_valid),
    .box_ray_i(box_ray),
    .box_group_i(box_group),
    .box_leaf_i(box_leaf),
    .limit_ray_o(leaf_ray),
    .limit_i(leaf_limit),
    .ended_i(leaf_ended),
    .crowded_i(leaf_crowded),
    .held_o(held),
    .triangle_valid_o(triangle_valid),
    .triangle_ready_i(triangle_ready),
    .triangle_ray_o(triangle_ray),
    .triangle_line_o(triangle_line)
  );

  // ---- Memory

  logic node_here, triangle_here, tests_allowed;
  logic [LineWidth-1:0] node_words;
  logic [ray_core_pkg::TriangleWidth-1:0] triangle_words;

  line_port #(
    .Rays(Rays),
    .NodeLines(NodeLines),
    .TriangleLines(TriangleLines)
  ) u_port (
    .clk_i,
    .rst_ni,
    .invalidate_i,
    .reading_o,
    .node_i(node),
    .node_ray_i(node_ray),
    .node_line_i(node_line),
    .soon_i(soon),
    .soon_line_i(soon_line),
    .triangle_i(triangle_valid),
    .triangle_ready_o(triangle_ready),
    .triangle_ray_i(triangle_ray),
    .triangle_line_i(triangle_line),
    .read_valid_o,
    .read_ready_i,
    .read_line_o,
    .read_tag_o,
    .line_valid_i,
    .line_ready_o,
    .line_tag_i,
    .line_i,
    .tests_allowed_i(tests_allowed),
    .node_valid_o(node_here),
    .node_ray_o(node_line_ray),
    .node_o(node_words),
    .triangle_valid_o(triangle_here),
    .triangle_ray_o(triangle_line_ray),
    .triangle_o(triangle_words)
  );

  // ---- Boxes

  logic [30:0] box_limit;

  box_test #(
    .Rays(Rays),
    .Arith(Arith),
    .Adder(Adder)
  ) u_boxes (
    .clk_i,
    .rst_ni,
    .valid_i(node_here),
    .slot_i(node_line_ray),
    .node_i(node_words),
    .origin_i(node_origin),
    .inverse_i(node_inverse),
    .limit_i(box_limit),
    .every_box_i(node_every_box),
    .valid_o(box_valid),
    .slot_o(box_ray),
    .group_o(box_group),
    .inner_o(box_inner),
    .leaf_o(box_leaf)
  );

  // ---- Tests

  logic over, found, doubt, point_valid, result_ignored;
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
    .slot_i(triangle_line_ray),
    .triangle_i(triangle_words),
    .origin_i(triangle_origin),
    .ignored_i(ignored),
    .direction_slot_o(set_ray),
    .direction_i(direction),
    .closed_o(over),
    .slot_o(result_ray),
    .triangle_o(result_triangle),
    .is_ignored_o(result_ignored),
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

  logic near_tie, doubt_valid, doubt_taken;
  logic [31:0] doubt_tag, doubt_triangle, end_triangle, end_t;
  logic [TErrorWidth-1:0] end_t_error;
  logic [TestsWidth-1:0] end_tests;
  logic end_found;
  logic [RayWidth-1:0] point_slot;
  logic [95:0] end_point;

  ray_hits #(
    .Rays(Rays)
  ) u_hits (
    .clk_i,
    .rst_ni,
    .load_i(start_taken),
    .load_ray_i(slot),
    .load_limit_i(start_limit),
    .load_any_hit_i(start_any_hit),
    .test_i(triangle_valid & triangle_ready),
    .test_ray_i(triangle_ray),
    .tests_allowed_o(tests_allowed),
    .result_i(over),
    .result_ray_i(result_ray),
    .result_tag_i(result_tag),
    .result_triangle_i(result_triangle),
    .result_ignored_i(result_ignored),
    .result_doubt_i(doubt),
    .result_hit_i(found),
    .result_t_i(t),
    .result_t_error_i(t_error),
    .result_normal_error_i(normal_error),
    .result_distance_error_i(distance_error),
    .point_valid_i(point_valid),
    .point_i(point),
    .walk_ray_i(walk_ray),
    .walk_limit_o(walk_limit),
    .walk_ended_o(walk_ended),
    .leaf_ray_i(leaf_ray),
    .leaf_limit_o(leaf_limit),
    .leaf_ended_o(leaf_ended),
    .leaf_crowded_o(leaf_crowded),
    .box_ray_i(node_line_ray),
    .box_limit_o(box_limit),
    .testing_o(testing),
    .doubt_valid_o(doubt_valid),
    .doubt_tag_o(doubt_tag),
    .doubt_triangle_o(doubt_triangle),
    .doubt_taken_i(doubt_taken),
    .end_ray_i(ending_slot),
    .end_found_o(end_found),
    .end_triangle_o(end_triangle),
    .end_t_o(end_t),
    .end_t_error_o(end_t_error),
    .end_tests_o(end_tests),
    .point_ray_i(point_slot),
    .point_o(end_point),
    .near_tie_o(near_tie)
  );

  // ---- Results

  ray_ends #(
    .Rays(Rays)
  ) u_ends (
    .clk_i,
    .rst_ni,
    .start_i(start_taken),
    .start_slot_i(slot),
    .busy_i(walking | held | testing),
    .ending_o(ending),
    .ending_slot_o(ending_slot),
    .ending_tag_i(ending_tag),
    .ending_found_i(end_found),
    .ending_triangle_i(end_triangle),
    .ending_t_i(end_t),
    .ending_t_error_i(end_t_error),
    .ending_tests_i(end_tests),
    .point_slot_o(point_slot),
    .point_i(end_point),
    .doubt_valid_i(doubt_valid),
    .doubt_tag_i(doubt_tag),
    .doubt_triangle_i(doubt_triangle),
    .doubt_taken_o(doubt_taken),
    .rest_valid_i(rest_valid),
    .rest_tag_i(rest_tag),
    .rest_line_i(rest_line),
    .rest_nodes_i(rest_nodes),
    .rest_taken_o(rest_taken),
    .result_valid_o,
    .result_ready_i,
    .result_kind_o,
    .result_tag_o,
    .result_found_o,
    .result_triangle_o,
    .result_t_o,
    .result_t_error_o,
    .result_point_o,
    .result_tests_o,
    .result_line_o,
    .result_nodes_o
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
    events[ray_core_pkg::EventRest]     = rest_taken;
    events[ray_core_pkg::EventRead]     = read_valid_o & read_ready_i;
    events[ray_core_pkg::EventWait]     = read_valid_o & ~read_ready_i;
  end
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) events_o <= '0;
    else events_o <= events;
  end

endmodule
