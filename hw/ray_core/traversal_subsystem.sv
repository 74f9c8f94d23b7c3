// Traversal: what the rays in flight have still to visit, and what is known of each.
//
//   traversal        the stacks, and which ray goes to its next node
//   primitive_fetch  the triangles of the leaves that it enters
//   closest_hit      its nearest hit and t_max, its doubts
//   exact_resolver   with Exact: what doubts mean for it
//   ray_errors       why its hits must not be believed
module traversal_subsystem #(
  parameter int unsigned Rays  = 64,
  parameter int unsigned Depth = 8,
  parameter int unsigned Levels = ray_core_pkg::Levels,
  parameter int unsigned Exact = 0,  // exact_units; 0: doubts leave
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned RayWidth = $clog2(Rays),
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    abort_i,
  input  logic [AddressWidth-1:0] lines_i,  // of memory
  // a ray begins
  input  logic [RayWidth-1:0]     start_ctx_i,
  // verilator lint_off UNUSEDSIGNAL
  // Vectors and corners are exact_resolver's.
  input  ray_core_pkg::start_t    start_i,
  output logic                    start_fire_o,
  // what is found
  input  logic [RayWidth-1:0]     box_ctx_i,
  input  ray_core_pkg::boxes_t    boxes_i,
  input  logic [RayWidth-1:0]     verdict_ctx_i,
  input  ray_core_pkg::verdict_t  verdict_i,
  // lines asked for
  output logic [RayWidth-1:0]     node_ctx_o,
  output ray_core_pkg::request_t  node_o,
  output ray_core_pkg::request_t  prefetch_o,
  output logic [RayWidth-1:0]     triangle_ctx_o,
  output ray_core_pkg::triangle_request_t triangle_o,
  input  logic                    triangle_ready_i,
  // lines that come: the ray's t_max in the clock after, and whether they are errors
  input  logic [RayWidth-1:0]     node_line_ctx_i,
  input  logic                    node_error_i,
  output logic [30:0]             t_max_o,
  input  logic [RayWidth-1:0]     triangle_line_ctx_i,
  input  ray_core_pkg::triangle_line_t triangle_line_i,
  // verilator lint_on UNUSEDSIGNAL
  // results
  output logic [Rays-1:0]         busy_o,  // rays that have something to be done
  output ray_core_pkg::doubt_t    doubt_o,
  input  logic                    doubt_fire_i,
  output logic [6:0]              events_o,  // EventExact, EventOverflow to EventTriangle
  input  logic [RayWidth-1:0]     end_ctx_i,
  output ray_core_pkg::end_t      end_o,  // in the same clock
  input  logic [RayWidth-1:0]     point_ctx_i,
  output logic [95:0]             point_o  // in the next one
);

  logic [31:0] tags[Rays];

  always_ff @(posedge clk_i) if (start_fire_o) tags[start_ctx_i] <= start_i.tag;

  assign end_o.tag = tags[end_ctx_i];

  // ---- Nodes

  logic [RayWidth-1:0] traversal_ray, leaf_ray, cycle_ray;
  logic [30:0] traversal_t_max, leaf_t_max;
  logic traversal_ended, leaf_ended, cycle, overflow;
  logic [Rays-1:0] leaf_pending, testing, traversing, failed;

  traversal #(
    .Rays(Rays),
    .Depth(Depth),
    .Levels(Levels)
  ) u_traversal (
    .clk_i,
    .rst_ni,
    .start_valid_i(start_i.valid),
    .start_ray_i(start_ctx_i),
    .start_fire_o,
    .box_valid_i(boxes_i.valid),
    .box_ray_i(box_ctx_i),
    .box_group_i(boxes_i.group),
    .box_inner_i(boxes_i.inner),
    .leaf_pending_i(leaf_pending),
    .testing_i(testing),
    .t_max_ray_o(traversal_ray),
    .t_max_i(traversal_t_max),
    .ended_i(traversal_ended),
    .cycle_o(cycle),
    .cycle_ray_o(cycle_ray),
    .lines_i,
    .traversing_o(traversing),
    .node_ray_o(node_ctx_o),
    .node_o,
    .prefetch_o,
    .overflow_o(overflow)
  );

  // ---- Triangles asked for: for doubts first

  logic [RayWidth-1:0] fetch_ray, exact_ray, open_ray;
  logic [Rays-1:0] doubtful, idle;
  logic tests_allowed, test, doubt_taken, exact_found, exact_ended, computing, near_tie;
  logic [2:0] verdict_kind;
  logic [AddressWidth-1:0] exact_found_line;
  logic [30:0] exact_t_max;
  ray_core_pkg::request_t fetch;
  ray_core_pkg::triangle_request_t exact;
  ray_core_pkg::open_t open;

  assign idle   = ~(traversing | leaf_pending | testing);
  assign busy_o = ~idle | doubtful;

  assign triangle_o     = exact.valid ? exact : {fetch.valid & tests_allowed, 1'b0, fetch.line};
  assign triangle_ctx_o = exact.valid ? exact_ray : fetch_ray;
  assign test           = triangle_o.valid & triangle_ready_i & ~triangle_o.exact;

  assign verdict_kind = verdict_i.is_skipped ? 3'b010
      : {verdict_i.doubt, ~verdict_i.found & ~verdict_i.doubt, verdict_i.found};
  assign events_o = {
    computing,
    overflow,
    near_tie,
    {3{verdict_i.valid}} & verdict_kind,
    triangle_line_i.valid & ~triangle_line_i.exact
  };

  // ---- Leaves

  primitive_fetch #(
    .Rays(Rays)
  ) u_primitives (
    .clk_i,
    .rst_ni,
    .box_valid_i(boxes_i.valid),
    .box_ray_i(box_ctx_i),
    .box_group_i(boxes_i.group),
    .box_leaf_i(boxes_i.leaf),
    .t_max_ray_o(leaf_ray),
    .t_max_i(leaf_t_max),
    .ended_i(leaf_ended),
    .leaf_pending_o(leaf_pending),
    .triangle_ray_o(fetch_ray),
    .triangle_o(fetch),
    .triangle_ready_i(triangle_ready_i & tests_allowed & ~exact.valid)
  );

  // ---- Hits and errors

  closest_hit #(
    .Rays(Rays),
    .Exact(Exact != 0)
  ) u_closest_hit (
    .clk_i,
    .rst_ni,
    .load_i(start_fire_o),
    .load_ray_i(start_ctx_i),
    .load_t_max_i(start_i.t_max),
    .load_any_hit_i(start_i.any_hit),
    .test_i(test),
    .test_ray_i(triangle_ctx_o),
    .settle_i(exact.valid),
    .tests_allowed_o(tests_allowed),
    .result_ray_i(verdict_ctx_i),
    .result_tag_i(tags[verdict_ctx_i]),
    .result_i(verdict_i),
    .failed_i(failed),
    .traversal_ray_i(traversal_ray),
    .traversal_t_max_o(traversal_t_max),
    .traversal_ended_o(traversal_ended),
    .leaf_ray_i(leaf_ray),
    .leaf_t_max_o(leaf_t_max),
    .leaf_ended_o(leaf_ended),
    .box_ray_i(node_line_ctx_i),
    .box_t_max_o(t_max_o),
    .testing_o(testing),
    .exact_ray_i(exact_ray),
    .exact_found_o(exact_found),
    .exact_ended_o(exact_ended),
    .exact_triangle_o(exact_found_line),
    .exact_t_max_o(exact_t_max),
    .doubt_o,
    .doubt_fire_i(doubt_fire_i | doubt_taken),
    .open_ray_o(open_ray),
    .open_o(open),
    .end_ray_i(end_ctx_i),
    .end_o(end_o.hit),
    .point_ray_i(point_ctx_i),
    .point_o,
    .near_tie_o(near_tie)
  );

  if (Exact != 0) begin : gen_exact
    exact_resolver #(
      .Rays(Rays),
      .Units(Exact),
      .Arith(Arith),
      .Adder(Adder)
    ) u_resolver (
      .clk_i,
      .rst_ni,
      .load_i(start_fire_o),
      .load_ctx_i(start_ctx_i),
      .load_origin_i(start_i.origin),
      .load_direction_i(start_i.direction),
      .open_ctx_i(open_ray),
      .open_i(open),
      .taken_o(doubt_taken),
      .idle_i(idle),
      .busy_o(doubtful),
      .ctx_o(exact_ray),
      .ended_i(exact_ended),
      .found_i(exact_found),
      .found_line_i(exact_found_line),
      .t_max_i(exact_t_max),
      .request_o(exact),
      .request_ready_i(triangle_ready_i),
      .line_i(triangle_line_i),
      .computing_o(computing)
    );
  end else begin : gen_doubts
    assign doubt_taken = 1'b0;
    assign doubtful    = '0;
    assign exact       = '0;
    assign exact_ray   = '0;
    assign computing   = 1'b0;

    logic unused_exact;
    assign unused_exact = ^{
      exact_found, exact_ended, exact_found_line, exact_t_max, open_ray, open
    };
  end

  ray_errors #(
    .Rays(Rays)
  ) u_errors (
    .clk_i,
    .rst_ni,
    .abort_i,
    .start_i(start_fire_o),
    .start_ctx_i,
    .start_scaled_i(start_i.is_scaled),
    .node_i(node_error_i),
    .node_ctx_i(node_line_ctx_i),
    .triangle_i(triangle_line_i.valid & triangle_line_i.error),
    .triangle_ctx_i(triangle_line_ctx_i),
    .cycle_i(cycle),
    .cycle_ctx_i(cycle_ray),
    .failed_o(failed),
    .end_ctx_i,
    .end_error_o(end_o.error)
  );

endmodule
