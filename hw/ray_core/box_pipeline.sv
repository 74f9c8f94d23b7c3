// Box pipeline: box_unit with a valid and the ray's context beside it. Origin, inverse and no_cull_i come a clock after
// the node.
// Latency: ray_core_pkg::BoxLatency clocks. Takes a node and a ray in each clock; never stalls.
module box_pipeline #(
  parameter int unsigned Rays  = 64,
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                                clk_i,
  input  logic                                rst_ni,
  input  logic                                valid_i,
  input  logic [RayWidth-1:0]                 ctx_i,
  input  logic [ray_core_pkg::LineWidth-1:0]  node_i,
  input  logic [95:0]                         origin_i,
  input  logic [95:0]                         inverse_i,
  input  logic [30:0]                         t_max_i,
  input  logic                                no_cull_i,
  output logic                                valid_o,
  output logic [RayWidth-1:0]                 ctx_o,
  output logic [ray_core_pkg::GroupWidth-1:0] group_o,
  output logic [ray_core_pkg::Children-1:0]   inner_o,
  output logic [ray_core_pkg::Children-1:0]   leaf_o
);

  localparam int unsigned Latency = ray_core_pkg::BoxLatency;

  logic [Latency-1:0] valid_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= '0;
    else valid_q <= {valid_q[Latency-2:0], valid_i};
  end
  assign valid_o = valid_q[Latency-1];

  delay_line #(
    .Width(RayWidth),
    .Depth(Latency)
  ) u_ctx (
    .clk_i,
    .enable_i(1'b1),
    .data_i(ctx_i),
    .data_o(ctx_o)
  );
  box_unit #(
    .Arith(Arith),
    .Adder(Adder)
  ) u_unit (
    .clk_i,
    .node_i,
    .origin_i,
    .inverse_i,
    .t_max_i,
    .no_cull_i,
    .group_o,
    .inner_o,
    .leaf_o
  );

endmodule
