// The one memory port: nodes and triangles that rays ask for, each kind through a cache of its own.
//
// What the caches lack goes out in turn, with a tag, {is a triangle's, alone, waiter, place}, see line_cache;
// its line may come back at any time and in any order. Each clock gives a node and a triangle where both caches have one.
module line_port #(
  parameter int unsigned Rays          = 64,
  parameter int unsigned NodeLines     = 256,  // of the nodes' cache
  parameter int unsigned TriangleLines = 256,  // of the triangles'
  localparam int unsigned RayWidth = $clog2(Rays),
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth,
  localparam int unsigned PlaceWidth =
      $clog2(NodeLines > TriangleLines ? NodeLines : TriangleLines),
  localparam int unsigned TagWidth = 2 + RayWidth + PlaceWidth,
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
  localparam int unsigned MissWidth = 1 + RayWidth + AddressWidth;  // as many waiters as rays

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

  logic line_valid, fill, fill_triangle, fill_alone, node_done, triangle_done;
  logic [RayWidth-1:0] fill_waiter;
  logic [PlaceWidth-1:0] fill_place;
  logic [LineWidth-1:0] line;
  logic [MissWidth-1:0] node_miss, triangle_miss;
  logic node_miss_valid, node_miss_ready, triangle_miss_valid, triangle_miss_ready;

  fifo #(
    .Width(TagWidth + LineWidth),
    .Depth(2)
  ) u_lines (
    .clk_i,
    .rst_ni,
    .push_i(line_valid_i & line_ready_o),
    .data_i({line_tag_i, line_i}),
    .space_o(line_ready_o),
    .pop_i(fill & (fill_triangle ? triangle_done : node_done)),
    .valid_o(line_valid),
    .data_o({fill_triangle, fill_alone, fill_waiter, fill_place, line})
  );
  assign fill = line_valid & tests_allowed_i;

  line_cache #(
    .Lines(NodeLines),
    .Waiters(Rays),
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
    .miss_waiter_o(node_miss[MissWidth-2 -: RayWidth]),
    .miss_alone_o(node_miss[MissWidth-1]),
    .miss_number_o(node_miss[AddressWidth-1:0]),
    .fill_i(fill & ~fill_triangle),
    .fill_done_o(node_done),
    .fill_waiter_i(fill_waiter),
    .fill_alone_i(fill_alone),
    .fill_index_i(fill_place[$clog2(NodeLines)-1:0]),
    .fill_line_i(line),
    .valid_o(node_valid_o),
    .ready_i(1'b1),
    .ray_o(node_ray_o),
    .line_o(node_o)
  );
  line_cache #(
    .Lines(TriangleLines),
    .Waiters(Rays),
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
    .miss_waiter_o(triangle_miss[MissWidth-2 -: RayWidth]),
    .miss_alone_o(triangle_miss[MissWidth-1]),
    .miss_number_o(triangle_miss[AddressWidth-1:0]),
    .fill_i(fill & fill_triangle),
    .fill_done_o(triangle_done),
    .fill_waiter_i(fill_waiter),
    .fill_alone_i(fill_alone),
    .fill_index_i(fill_place[$clog2(TriangleLines)-1:0]),
    .fill_line_i(line[TriangleWidth-1:0]),
    .valid_o(triangle_valid_o),
    .ready_i(tests_allowed_i),
    .ray_o(triangle_ray_o),
    .line_o(triangle_o)
  );

  // ---- What they lack, in turn

  logic [MissWidth:0] out;
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
    .Width(1 + MissWidth),
    .Depth(2)
  ) u_out (
    .clk_i,
    .rst_ni,
    .push_i(out_ready & (node_miss_valid | triangle_miss_valid)),
    .data_i((node_miss_valid & node_miss_ready) ? {1'b0, node_miss} : {1'b1, triangle_miss}),
    .space_o(out_ready),
    .pop_i(read_valid_o & read_ready_i),
    .valid_o(read_valid_o),
    .data_o(out)
  );
  assign read_line_o = out[AddressWidth-1:0];
  assign read_tag_o  = {out[MissWidth -: 2 + RayWidth], out[PlaceWidth-1:0]};

endmodule
