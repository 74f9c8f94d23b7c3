// The one memory port: nodes and triangles that rays ask for, each kind through a cache of its own.
//
// What the caches lack goes out in turn, with a tag, {is a triangle's, ray, line}; its line may come back at
// any time and in any order. Each clock gives a node and a triangle where both caches have one.
module line_port #(
  parameter int unsigned Rays          = 64,
  parameter int unsigned NodeLines     = 256,  // of the nodes' cache
  parameter int unsigned TriangleLines = 256,  // of the triangles'
  localparam int unsigned RayWidth = $clog2(Rays),
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth,
  localparam int unsigned TagWidth = 1 + RayWidth + AddressWidth,
  localparam int unsigned LineWidth = ray_core_pkg::LineWidth,
  localparam int unsigned TriangleWidth = ray_core_pkg::TriangleWidth
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    invalidate_i,  // the caches: memory has changed
  // nodes asked for: one for each ray at most
  input  logic                    node_i,
  input  logic [RayWidth-1:0]     node_ray_i,
  input  logic [AddressWidth-1:0] node_line_i,
  // triangles asked for
  input  logic                    triangle_i,
  output logic                    triangle_ready_o,
  input  logic [RayWidth-1:0]     triangle_ray_i,
  input  logic [AddressWidth-1:0] triangle_line_i,
  // memory
  output logic                    read_valid_o,
  input  logic                    read_ready_i,
  output logic [AddressWidth-1:0] read_line_o,
  output logic [TagWidth-1:0]     read_tag_o,
  input  logic                    line_valid_i,
  output logic                    line_ready_o,
  input  logic [TagWidth-1:0]     line_tag_i,
  input  logic [LineWidth-1:0]    line_i,
  // lines
  input  logic                    tests_allowed_i,  // else no triangle leaves
  output logic                    node_valid_o,
  output logic [RayWidth-1:0]     node_ray_o,
  output logic [LineWidth-1:0]    node_o,
  output logic                    triangle_valid_o,
  output logic [RayWidth-1:0]     triangle_ray_o,
  output logic [TriangleWidth-1:0] triangle_o
);

  localparam int unsigned RequestWidth = RayWidth + AddressWidth;

  // ---- What is asked for

  logic node_valid, node_taken, triangle_valid, triangle_taken, unused_space;
  logic [RequestWidth-1:0] node, triangle;

  fifo #(
    .Width(RequestWidth),
    .Depth(Rays)
  ) u_nodes (
    .clk_i,
    .rst_ni,
    .push_i(node_i),
    .data_i({node_ray_i, node_line_i}),
    .space_o(unused_space),
    .pop_i(node_valid & node_taken),
    .valid_o(node_valid),
    .data_o(node)
  );
  fifo #(
    .Width(RequestWidth),
    .Depth(4)
  ) u_triangles (
    .clk_i,
    .rst_ni,
    .push_i(triangle_i & triangle_ready_o),
    .data_i({triangle_ray_i, triangle_line_i}),
    .space_o(triangle_ready_o),
    .pop_i(triangle_valid & triangle_taken),
    .valid_o(triangle_valid),
    .data_o(triangle)
  );

  // ---- Caches

  logic fill, fill_triangle;
  logic [RequestWidth-1:0] fill_request, node_miss, triangle_miss;
  logic node_miss_valid, node_miss_ready, triangle_miss_valid, triangle_miss_ready;

  assign line_ready_o = tests_allowed_i;
  assign fill         = line_valid_i & line_ready_o;
  assign {fill_triangle, fill_request} = line_tag_i;

  line_cache #(
    .Lines(NodeLines),
    .RayWidth(RayWidth)
  ) u_node_cache (
    .clk_i,
    .rst_ni,
    .invalidate_i,
    .valid_i(node_valid),
    .ready_o(node_taken),
    .ray_i(node[RequestWidth-1 -: RayWidth]),
    .line_number_i(node[AddressWidth-1:0]),
    .miss_valid_o(node_miss_valid),
    .miss_ready_i(node_miss_ready),
    .miss_ray_o(node_miss[RequestWidth-1 -: RayWidth]),
    .miss_number_o(node_miss[AddressWidth-1:0]),
    .fill_i(fill & ~fill_triangle),
    .fill_ray_i(fill_request[RequestWidth-1 -: RayWidth]),
    .fill_number_i(fill_request[AddressWidth-1:0]),
    .fill_line_i(line_i),
    .valid_o(node_valid_o),
    .ready_i(1'b1),
    .ray_o(node_ray_o),
    .line_o(node_o)
  );
  line_cache #(
    .Lines(TriangleLines),
    .RayWidth(RayWidth),
    .Width(TriangleWidth)
  ) u_triangle_cache (
    .clk_i,
    .rst_ni,
    .invalidate_i,
    .valid_i(triangle_valid),
    .ready_o(triangle_taken),
    .ray_i(triangle[RequestWidth-1 -: RayWidth]),
    .line_number_i(triangle[AddressWidth-1:0]),
    .miss_valid_o(triangle_miss_valid),
    .miss_ready_i(triangle_miss_ready),
    .miss_ray_o(triangle_miss[RequestWidth-1 -: RayWidth]),
    .miss_number_o(triangle_miss[AddressWidth-1:0]),
    .fill_i(fill & fill_triangle),
    .fill_ray_i(fill_request[RequestWidth-1 -: RayWidth]),
    .fill_number_i(fill_request[AddressWidth-1:0]),
    .fill_line_i(line_i[TriangleWidth-1:0]),
    .valid_o(triangle_valid_o),
    .ready_i(tests_allowed_i),
    .ray_o(triangle_ray_o),
    .line_o(triangle_o)
  );

  // ---- What they lack, in turn

  logic out_ready, node_last_q;  // the last request was a node's

  assign node_miss_ready     = out_ready & (~triangle_miss_valid | ~node_last_q);
  assign triangle_miss_ready = out_ready & ~(node_miss_valid & node_miss_ready);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) node_last_q <= 1'b0;
    else if (out_ready & (node_miss_valid | triangle_miss_valid)) begin
      node_last_q <= node_miss_valid & node_miss_ready;
    end
  end

  fifo #(
    .Width(1 + RequestWidth),
    .Depth(2)
  ) u_out (
    .clk_i,
    .rst_ni,
    .push_i(out_ready & (node_miss_valid | triangle_miss_valid)),
    .data_i((node_miss_valid & node_miss_ready) ? {1'b0, node_miss} : {1'b1, triangle_miss}),
    .space_o(out_ready),
    .pop_i(read_valid_o & read_ready_i),
    .valid_o(read_valid_o),
    .data_o(read_tag_o)
  );
  assign read_line_o = read_tag_o[AddressWidth-1:0];

endmodule
