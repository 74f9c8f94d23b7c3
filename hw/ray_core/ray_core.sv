// The ray core: rays in, nearest sure hits and doubts out; it walks the tree of boxes in memory by itself.
//
//   ray_intake         a slot of the table for each ray, 1 / I_k
//   ray_walk           the stacks, and which ray goes to its next node
//   line_port          nodes and triangles, from caches or memory
//   box_unit           which children of a node a ray enters
//   leaf_walk          the triangles of the leaves among them
//   set_up_unit        a triangle's record, seen from the ray's origin
//   hit_test_pipeline  hit, miss or doubt; t, P
//   ray_hits           each ray's nearest hit and limit, and the doubts
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
// valid/ready.
//
// Throughput: a node and a triangle a clock, out of the caches; a line a clock of what they lack.
module ray_core #(
  parameter int unsigned Rays  = 64,  // in flight; a power of two
  parameter int unsigned Depth = 8,   // groups on a ray's stack
  parameter int unsigned NodeLines     = 256,  // of the cache of nodes; a power of two
  parameter int unsigned TriangleLines = 256,  // of the cache of triangles; likewise
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned RayWidth = $clog2(Rays),
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth,
  localparam int unsigned TagWidth = 1 + RayWidth + AddressWidth,
  localparam int unsigned LineWidth = ray_core_pkg::LineWidth,
  localparam int unsigned NodesWidth = ray_core_pkg::NodesWidth,
  localparam int unsigned TestsWidth = ray_core_pkg::TestsWidth,
  localparam int unsigned TErrorWidth = set_up_pkg::TErrorExponentWidth
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    invalidate_i,  // memory has changed; only while no ray is here
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
  output logic [ray_core_pkg::NumEvents-1:0] events_o  // this clock's, see event_e
);

  localparam int unsigned GroupWidth = ray_core_pkg::GroupWidth;
  localparam int unsigned Children = ray_core_pkg::Children;
  localparam int unsigned PlaneErrorWidth = set_up_pkg::PlaneErrorWidth;

  // ---- The table: what is known of a ray from its beginning

  logic [95:0] origins[Rays];
  logic [95:0] directions[Rays];
  logic [95:0] inverses[Rays];
  logic [31:0] ignored[Rays];
  logic [31:0] tags[Rays];
  logic [AddressWidth-1:0] starts[Rays];
  logic [Rays-1:0] every_box_q;

  logic taken, inverse_valid, start_valid, start_taken, end_given;
  logic [RayWidth-1:0] slot, inverse_slot, start_slot, end_ray;
  logic [95:0] inverse;

  assign taken = ray_valid_i & ray_ready_o;

  ray_intake #(
    .Rays(Rays),
    .Arith(Arith),
    .Adder(Adder)
  ) u_intake (
    .clk_i,
    .rst_ni,
    .valid_i(ray_valid_i),
    .ready_o(ray_ready_o),
    .direction_i(ray_direction_i),
    .slot_o(slot),
    .free_valid_i(end_given),
    .free_slot_i(end_ray),
    .inverse_valid_o(inverse_valid),
    .inverse_slot_o(inverse_slot),
    .inverse_o(inverse),
    .start_valid_o(start_valid),
    .start_slot_o(start_slot),
    .start_taken_i(start_taken)
  );

  always_ff @(posedge clk_i) begin
    if (taken) begin
      origins[slot]     <= ray_origin_i;
      directions[slot]  <= ray_direction_i;
      ignored[slot]     <= ray_ignored_i;
      tags[slot]        <= ray_tag_i;
      starts[slot]      <= ray_start_i;
      every_box_q[slot] <= ray_every_box_i;
    end
    if (inverse_valid) inverses[inverse_slot] <= inverse;
  end

  // ---- Walk

  logic box_valid, walk_ended, leaf_ended, leaf_crowded, node, rest_valid, rest_taken;
  logic [RayWidth-1:0] box_ray, walk_ray, leaf_ray, node_ray, rest_ray;
  logic [GroupWidth-1:0] box_group;
  logic [Children-1:0] box_inner, box_leaf;
  logic [30:0] walk_limit, leaf_limit;
  logic [Rays-1:0] held, testing, walking;
  logic [AddressWidth-1:0] node_line, rest_line;
  logic [NodesWidth-1:0] rest_nodes;

  ray_walk #(
    .Rays(Rays),
    .Depth(Depth)
  ) u_walk (
    .clk_i,
    .rst_ni,
    .start_valid_i(start_valid),
    .start_ray_i(start_slot),
    .start_line_i(starts[start_slot]),
    .start_taken_o(start_taken),
    .box_valid_i(box_valid),
    .box_ray_i(box_ray),
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
    .rest_valid_o(rest_valid),
    .rest_ray_o(rest_ray),
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
  logic [RayWidth-1:0] node_line_ray, triangle_line_ray;
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
    .node_i(node),
    .node_ray_i(node_ray),
    .node_line_i(node_line),
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
  logic [ray_core_pkg::BoxLatency-1:0] boxing_q;

  box_unit #(
    .Arith(Arith),
    .Adder(Adder)
  ) u_boxes (
    .clk_i,
    .node_i(node_words),
    .origin_i(origins[node_line_ray]),
    .inverse_i(inverses[node_line_ray]),
    .limit_i(box_limit),
    .every_box_i(every_box_q[node_line_ray]),
    .group_o(box_group),
    .inner_o(box_inner),
    .leaf_o(box_leaf)
  );
  delay_line #(
    .Width(RayWidth),
    .Depth(ray_core_pkg::BoxLatency)
  ) u_box_ray (
    .clk_i,
    .enable_i(1'b1),
    .data_i(node_line_ray),
    .data_o(box_ray)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) boxing_q <= '0;
    else boxing_q <= {boxing_q[ray_core_pkg::BoxLatency-2:0], node_here};
  end
  assign box_valid = boxing_q[ray_core_pkg::BoxLatency-1];

  // ---- Set up

  logic [hit_test_pkg::RecordWords*32-1:0] set_record;
  logic [PlaneErrorWidth-1:0] set_normal_error, set_distance_error;
  logic [set_up_pkg::Latency-1:0] setting_q;
  logic [RayWidth-1:0] set_ray;
  logic [31:0] set_triangle;
  logic set_ignored;

  set_up_unit #(
    .Arith(Arith),
    .Adder(Adder)
  ) u_set_up (
    .clk_i,
    .origin_i(origins[triangle_line_ray]),
    .corners_i(triangle_words[ray_core_pkg::TriangleCorners +: 9*32]),
    .record_o(set_record),
    .normal_error_o(set_normal_error),
    .distance_error_o(set_distance_error)
  );
  delay_line #(
    .Width(RayWidth + 32 + 1),
    .Depth(set_up_pkg::Latency)
  ) u_beside_set_up (
    .clk_i,
    .enable_i(1'b1),
    .data_i({triangle_line_ray, triangle_words[ray_core_pkg::TriangleIndex +: 32],
             triangle_words[ray_core_pkg::TriangleIndex +: 32] == ignored[triangle_line_ray]}),
    .data_o({set_ray, set_triangle, set_ignored})
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) setting_q <= '0;
    else setting_q <= {setting_q[set_up_pkg::Latency-2:0], triangle_here};
  end

  // ---- Test: each triangle is a burst of its own

  localparam int unsigned TestTagWidth = 2 * PlaneErrorWidth + 1 + RayWidth + 32;

  logic unused_ready, word_valid, closed, found, point_valid;
  hit_test_pkg::report_e report;
  logic [TestTagWidth-1:0] report_tag, found_tag, tag;
  logic [31:0] t, result_triangle;
  logic [hit_test_pkg::TErrorWidth-1:0] t_error;
  logic [95:0] point;
  logic [hit_test_pkg::NumCounts-1:0] unused_events;
  logic [PlaneErrorWidth-1:0] normal_error, distance_error;
  logic [RayWidth-1:0] result_ray;
  logic result_ignored;

  hit_test_pipeline #(
    .Arith(Arith),
    .Adder(Adder),
    .TagWidth(TestTagWidth)
  ) u_tests (
    .clk_i,
    .rst_ni,
    .valid_i(setting_q[set_up_pkg::Latency-1]),
    .ready_o(unused_ready),  // always, as results are always taken
    .first_i(1'b1),
    .last_i(1'b1),
    .tag_i({set_normal_error, set_distance_error, set_ignored, set_ray, set_triangle}),
    .direction_i(directions[set_ray]),
    .record_i(set_record),
    .valid_o(word_valid),
    .ready_i(1'b1),
    .report_o(report),
    .report_tag_o(report_tag),
    .closed_o(closed),
    .found_o(found),
    .tag_o(found_tag),
    .t_o(t),
    .t_error_o(t_error),
    .point_valid_o(point_valid),
    .point_o(point),
    .events_o(unused_events)
  );

  assign tag = found ? found_tag : report_tag;
  assign {normal_error, distance_error, result_ignored, result_ray, result_triangle} = tag;

  // ---- Hits

  logic over, near_tie, doubt_valid, doubt_taken;
  logic [RayWidth-1:0] doubt_ray;
  logic [31:0] doubt_triangle, end_triangle, end_t;
  logic [95:0] end_point;
  logic [TErrorWidth-1:0] end_t_error;
  logic [TestsWidth-1:0] end_tests;
  logic end_found;

  assign over = word_valid & closed;

  ray_hits #(
    .Rays(Rays)
  ) u_hits (
    .clk_i,
    .rst_ni,
    .load_i(taken),
    .load_ray_i(slot),
    .load_limit_i(ray_limit_i),
    .load_any_hit_i(ray_any_hit_i),
    .test_i(triangle_valid & triangle_ready),
    .test_ray_i(triangle_ray),
    .tests_allowed_o(tests_allowed),
    .result_i(over),
    .result_ray_i(result_ray),
    .result_triangle_i(result_triangle),
    .result_ignored_i(result_ignored),
    .result_doubt_i(report == hit_test_pkg::ReportDoubt),
    .result_hit_i(found),
    .result_t_i(t),
    .result_t_error_i(t_error),
    .result_normal_error_i(normal_error),
    .result_distance_error_i(distance_error),
    .point_valid_i(word_valid & point_valid),
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
    .doubt_ray_o(doubt_ray),
    .doubt_triangle_o(doubt_triangle),
    .doubt_taken_i(doubt_taken),
    .end_ray_i(end_ray),
    .end_found_o(end_found),
    .end_triangle_o(end_triangle),
    .end_t_o(end_t),
    .end_t_error_o(end_t_error),
    .end_point_o(end_point),
    .end_tests_o(end_tests),
    .near_tie_o(near_tie)
  );

  // ---- The end: nothing to walk, to ask for or to test. P may be on its way still

  localparam int unsigned PointDelay = hit_test_pkg::divide_latency(23) + 4;

  logic [Rays-1:0] active_q;  // on its way, and its end not noticed
  logic ending, end_valid, unused_space;
  logic [RayWidth-1:0] ending_ray, pointed_ray;
  logic [PointDelay-1:0] pointing_q;

  rotating_pick #(
    .Width(Rays)
  ) u_end (
    .requests_i(active_q & ~walking & ~held & ~testing),
    .start_i('0),
    .valid_o(ending),
    .index_o(ending_ray)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      active_q   <= '0;
      pointing_q <= '0;
    end else begin
      if (start_taken) active_q[start_slot] <= 1'b1;
      if (ending) active_q[ending_ray] <= 1'b0;
      pointing_q <= {pointing_q[PointDelay-2:0], ending};
    end
  end
  delay_line #(
    .Width(RayWidth),
    .Depth(PointDelay)
  ) u_pointing (
    .clk_i,
    .enable_i(1'b1),
    .data_i(ending_ray),
    .data_o(pointed_ray)
  );
  fifo #(
    .Width(RayWidth),
    .Depth(Rays)
  ) u_ends (
    .clk_i,
    .rst_ni,
    .push_i(pointing_q[PointDelay-1]),
    .data_i(pointed_ray),
    .space_o(unused_space),
    .pop_i(end_given),
    .valid_o(end_valid),
    .data_o(end_ray)
  );

  // ---- Results: a ray's doubts and rests come before its end

  logic load;

  assign load        = ~result_valid_o | result_ready_i;
  assign doubt_taken = load & doubt_valid;
  assign rest_taken  = load & rest_valid & ~doubt_valid;
  assign end_given   = load & end_valid & ~doubt_valid & ~rest_valid;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) result_valid_o <= 1'b0;
    else if (load) result_valid_o <= doubt_valid | rest_valid | end_valid;
  end
  always_ff @(posedge clk_i) begin
    if (load) begin
      result_kind_o     <= doubt_valid ? ray_core_pkg::ResultDoubt
                         : rest_valid ? ray_core_pkg::ResultRest : ray_core_pkg::ResultEnd;
      result_tag_o      <= tags[doubt_valid ? doubt_ray : rest_valid ? rest_ray : end_ray];
      result_found_o    <= end_found & ~doubt_valid & ~rest_valid;
      result_triangle_o <= doubt_valid ? doubt_triangle : end_triangle;
      result_t_o        <= end_t;
      result_t_error_o  <= end_t_error;
      result_point_o    <= end_point;
      result_tests_o    <= end_tests;
      result_line_o     <= rest_line;
      result_nodes_o    <= rest_nodes;
    end
  end

  // ---- Events

  always_comb begin
    events_o = '0;
    events_o[ray_core_pkg::EventRay]      = end_given;
    events_o[ray_core_pkg::EventNode]     = node_here;
    events_o[ray_core_pkg::EventTriangle] = triangle_here;
    events_o[ray_core_pkg::EventHit]      = over & found;
    events_o[ray_core_pkg::EventMiss]     = over & ~found & (report != hit_test_pkg::ReportDoubt);
    events_o[ray_core_pkg::EventDoubt]    = over & (report == hit_test_pkg::ReportDoubt);
    events_o[ray_core_pkg::EventNearTie]  = near_tie;
    events_o[ray_core_pkg::EventRest]     = rest_taken;
    events_o[ray_core_pkg::EventRead]     = read_valid_o & read_ready_i;
    events_o[ray_core_pkg::EventWait]     = read_valid_o & ~read_ready_i;
  end

endmodule
