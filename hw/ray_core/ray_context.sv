// Contexts of the rays in flight: origin, direction, reciprocals and flags of each.
//
// A ray is in its context from the clock after start_fire_i until the context is another's. What a node, a triangle or
// a test needs is there in the clock after it was asked for.
module ray_context #(
  parameter int unsigned Rays  = 64,
  parameter int unsigned Clocks = 1,  // of a ray, see reciprocals
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                clk_i,
  input  logic                rst_ni,
  input  logic                valid_i,
  output logic                ready_o,
  input  ray_core_pkg::ray_t  ray_i,
  // a ray begins
  output logic [RayWidth-1:0] start_ctx_o,
  output ray_core_pkg::start_t start_o,
  input  logic                start_fire_i,
  // a ray has ended: its context is free
  input  logic                ending_i,
  input  logic [RayWidth-1:0] ending_ctx_i,
  // for the boxes of a node
  input  logic [RayWidth-1:0] node_ctx_i,
  output logic [95:0]         node_origin_o,
  output logic [95:0]         node_inverse_o,
  output logic                node_no_cull_o,
  // for a test: its triangle, then its ray; asked for with step_i
  input  logic                step_i,
  input  logic [RayWidth-1:0] triangle_ctx_i,
  output logic [95:0]         triangle_origin_o,
  output logic [31:0]         triangle_skip_id_o,
  output logic [31:0]         triangle_source_id_o,
  input  logic [RayWidth-1:0] direction_ctx_i,
  output logic [95:0]         direction_o
);

  ray_core_pkg::ray_t start;
  logic [95:0] inverse;

  ray_alloc #(
    .Rays(Rays),
    .Width($bits(ray_i)),
    .Clocks(Clocks),
    .Arith(Arith),
    .Adder(Adder)
  ) u_alloc (
    .clk_i,
    .rst_ni,
    .valid_i,
    .ready_o,
    .direction_i(ray_i.direction),
    .ray_i,
    .free_valid_i(ending_i),
    .free_ctx_i(ending_ctx_i),
    .start_valid_o(start_o.valid),
    .start_ctx_o,
    .start_inverse_o(inverse),
    .start_ray_o(start),
    .start_fire_i
  );

  ram #(
    .Width(96 + 96 + 1),
    .Depth(Rays)
  ) u_node (
    .clk_i,
    .write_i(start_fire_i),
    .write_address_i(start_ctx_o),
    .data_i({start.origin, inverse, start.no_cull}),
    .read_i(1'b1),
    .read_address_i(node_ctx_i),
    .data_o({node_origin_o, node_inverse_o, node_no_cull_o})
  );
  ram #(
    .Width(96 + 2 * 32),
    .Depth(Rays)
  ) u_triangle (
    .clk_i,
    .write_i(start_fire_i),
    .write_address_i(start_ctx_o),
    .data_i({start.origin, start.skip_id, start.source_id}),
    .read_i(step_i),
    .read_address_i(triangle_ctx_i),
    .data_o({triangle_origin_o, triangle_skip_id_o, triangle_source_id_o})
  );
  ram #(
    .Width(96),
    .Depth(Rays)
  ) u_direction (
    .clk_i,
    .write_i(start_fire_i),
    .write_address_i(start_ctx_o),
    .data_i(start.direction),
    .read_i(step_i),
    .read_address_i(direction_ctx_i),
    .data_o(direction_o)
  );

  assign start_o.tag       = start.tag;
  assign start_o.origin    = start.origin;
  assign start_o.direction = start.direction;
  assign start_o.t_max     = start.t_max;
  assign start_o.any_hit   = start.any_hit;
  assign start_o.is_scaled = ray_core_pkg::is_scaled(start.direction);

endmodule
