// Intersection: a ray's data by its context, the boxes of a node and the test of a triangle for it.
//
//   ray_context    the rays in flight; ray_alloc gives each its context, and 1 / I_k
//   box_unit       which children of a node a ray enters
//   triangle_test  hit, miss or doubt
//
// A node and a triangle are taken with step_i, in one of Clocks clocks: 1, or few cores that take turns, see slab_tests and
// shared_triangle_test. Nothing stalls. Boxes are there box_unit's latency after their node, a verdict as
// (shared_)triangle_test says.
module intersection_subsystem #(
  parameter int unsigned Rays  = 64,
  parameter int unsigned Clocks = 1,  // else at least 7
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                         clk_i,
  input  logic                         rst_ni,
  // a ray comes, begins, and has ended
  input  logic                         ray_valid_i,
  output logic                         ray_ready_o,
  input  ray_core_pkg::ray_t           ray_i,
  output logic [RayWidth-1:0]          start_ctx_o,
  output ray_core_pkg::start_t         start_o,
  input  logic                         start_fire_i,
  input  logic                         ending_i,
  input  logic [RayWidth-1:0]          ending_ctx_i,
  // lines for rays, with step_i
  input  logic                         step_i,
  input  logic [RayWidth-1:0]          node_ctx_i,
  input  ray_core_pkg::node_line_t     node_i,
  input  logic [30:0]                  t_max_i,  // of node_ctx_i, in the clock after
  input  logic [RayWidth-1:0]          triangle_ctx_i,
  input  ray_core_pkg::triangle_line_t triangle_i,
  // what is found
  output logic [RayWidth-1:0]          box_ctx_o,
  output ray_core_pkg::boxes_t         boxes_o,
  output logic [RayWidth-1:0]          verdict_ctx_o,
  output ray_core_pkg::verdict_t       verdict_o
);

  logic [95:0] box_origin, box_inverse, triangle_origin, direction;
  logic [31:0] skip_id, source_id;
  logic [RayWidth-1:0] direction_ctx;
  logic no_cull;

  ray_context #(
    .Rays(Rays),
    .Clocks(Clocks),
    .Arith(Arith),
    .Adder(Adder)
  ) u_contexts (
    .clk_i,
    .rst_ni,
    .valid_i(ray_valid_i),
    .ready_o(ray_ready_o),
    .ray_i,
    .start_ctx_o,
    .start_o,
    .start_fire_i,
    .ending_i,
    .ending_ctx_i,
    .node_ctx_i,
    .node_origin_o(box_origin),
    .node_inverse_o(box_inverse),
    .node_no_cull_o(no_cull),
    .step_i,
    .triangle_ctx_i,
    .triangle_origin_o(triangle_origin),
    .triangle_skip_id_o(skip_id),
    .triangle_source_id_o(source_id),
    .direction_ctx_i(direction_ctx),
    .direction_o(direction)
  );

  // ---- Boxes

  localparam int unsigned Latency = ray_core_pkg::BoxLatency
                                  + ((Clocks == 1) ? 0 : ray_core_pkg::Children);
  localparam int unsigned KindsWidth = ray_core_pkg::Children * ray_core_pkg::KindWidth;

  logic [ray_core_pkg::LineWidth-1:0] node;
  logic [Latency-1:0] valid_q;

  always_comb begin
    node = node_i.line;
    if (node_i.error) node[ray_core_pkg::NodeKinds+:KindsWidth] = '0;  // all absent
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= '0;
    else valid_q <= {valid_q[Latency-2:0], node_i.valid};
  end
  assign boxes_o.valid = valid_q[Latency-1];

  delay_line #(
    .Width(RayWidth),
    .Depth(Latency)
  ) u_ctx (
    .clk_i,
    .enable_i(1'b1),
    .data_i(node_ctx_i),
    .data_o(box_ctx_o)
  );
  box_unit #(
    .Clocks(Clocks),
    .Arith(Arith),
    .Adder(Adder)
  ) u_boxes (
    .clk_i,
    .start_i(node_i.valid),
    .node_i(node),
    .origin_i(box_origin),
    .inverse_i(box_inverse),
    .t_max_i,
    .no_cull_i(no_cull),
    .group_o(boxes_o.group),
    .inner_o(boxes_o.inner),
    .leaf_o(boxes_o.leaf)
  );

  // ---- Triangles

  if (Clocks == 1) begin : gen_pipeline
    triangle_test #(
      .Rays(Rays),
      .Arith(Arith),
      .Adder(Adder)
    ) u_tests (
      .clk_i,
      .rst_ni,
      .ctx_i(triangle_ctx_i),
      .triangle_i,
      .origin_i(triangle_origin),
      .skip_id_i(skip_id),
      .source_id_i(source_id),
      .direction_ctx_o(direction_ctx),
      .direction_i(direction),
      .ctx_o(verdict_ctx_o),
      .verdict_o
    );
  end else begin : gen_turns
    shared_triangle_test #(
      .Rays(Rays),
      .Clocks(Clocks),
      .Arith(Arith),
      .Adder(Adder)
    ) u_tests (
      .clk_i,
      .rst_ni,
      .step_i,
      .ctx_i(triangle_ctx_i),
      .triangle_i,
      .origin_i(triangle_origin),
      .skip_id_i(skip_id),
      .source_id_i(source_id),
      .direction_ctx_o(direction_ctx),
      .direction_i(direction),
      .ctx_o(verdict_ctx_o),
      .verdict_o
    );
  end

endmodule
