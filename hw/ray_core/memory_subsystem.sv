// Memory port of the ray core: two caches and their reads.
//
// A read has an id, {is a triangle's, cache entry}; its line may come back at any time and in any order. Both caches
// can deliver a line in the same clock. A line with an error goes to the rays that wait for it and is not kept.
//
// A node to be prefetched (prefetch_i) is looked up in a clock in which no node is asked for, and dropped if the queue
// of prefetches is full. Its line may come after the last ray has ended: while outstanding_o is high, memory must not
// change and the caches must not be emptied.
//
// Lines leave when step_o is high, in one of every Clocks clocks. line_ready_o never waits for results to be taken.
module memory_subsystem
  import ray_core_pkg::*;
#(
  parameter int unsigned Rays          = 64,
  parameter int unsigned NodeLines     = 256,  // lines of the cache of nodes
  parameter int unsigned TriangleLines = 256,  // lines of the cache of triangles
  parameter bit Exact = 1'b0,  // lines have ranks; some are for exact_resolver
  parameter int unsigned Clocks = 1,
  localparam int unsigned RayWidth = $clog2(Rays),
  localparam int unsigned ReadIdWidth = read_id_width(NodeLines, TriangleLines)
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    invalidate_i,  // empties the caches: memory has changed
  output logic                    outstanding_o,  // a line is requested, or will be
  // requests for nodes: one for each ray at most
  input  logic [RayWidth-1:0]     node_ctx_i,
  input  request_t                node_i,
  // a request for a node that may be needed soon: a prefetch
  input  request_t                prefetch_i,
  // requests for triangles
  input  logic [RayWidth-1:0]     triangle_ctx_i,
  input  triangle_request_t       triangle_i,
  output logic                    triangle_ready_o,
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
  // lines
  output logic                    step_o,
  output logic [RayWidth-1:0]     node_ctx_o,
  output node_line_t              node_o,
  output logic [RayWidth-1:0]     triangle_ctx_o,
  output triangle_line_t          triangle_o
);

  localparam int unsigned RequestWidth = RayWidth + AddressWidth;
  localparam int unsigned WhoWidth = RayWidth + (Exact ? 1 : 0);  // {for exact_resolver, context}
  localparam int unsigned KeptWidth = TriangleWidth + (Exact ? RankWidth : 0);
  localparam int unsigned EntryWidth = ReadIdWidth - 1;
  localparam int unsigned MissWidth = EntryWidth + AddressWidth;

  // ---- Requests

  logic node_valid, node_ready, triangle_valid, triangle_ready;
  logic [RequestWidth-1:0] node;
  logic [WhoWidth+AddressWidth-1:0] triangle;
  logic [WhoWidth-1:0] triangle_who, triangle_asker;
  logic [KeptWidth-1:0] triangle_kept;
  logic prefetch_valid, prefetch_fire, prefetch_space;
  logic [AddressWidth-1:0] prefetch_line;

  fifo #(
    .Width(RequestWidth),
    .Depth(Rays),
    .Memory(1'b1)
  ) u_nodes (
    .clk_i,
    .rst_ni,
    .push_i(node_i.valid),
    .data_i({node_ctx_i, node_i.line}),
    .space_o(),
    .pop_i(node_valid & node_ready),
    .valid_o(node_valid),
    .data_o(node)
  );
  fifo #(
    .Width(AddressWidth),
    .Depth(8)
  ) u_prefetches (
    .clk_i,
    .rst_ni,
    .push_i(prefetch_i.valid & prefetch_space),
    .data_i(prefetch_i.line),
    .space_o(prefetch_space),
    .pop_i(prefetch_fire),
    .valid_o(prefetch_valid),
    .data_o(prefetch_line)
  );
  assign triangle_asker = WhoWidth'({triangle_i.exact, triangle_ctx_i});

  fifo #(
    .Width(WhoWidth + AddressWidth),
    .Depth(4)
  ) u_triangles (
    .clk_i,
    .rst_ni,
    .push_i(triangle_i.valid & triangle_ready_o),
    .data_i({triangle_asker, triangle_i.line}),
    .space_o(triangle_ready_o),
    .pop_i(triangle_valid & triangle_ready),
    .valid_o(triangle_valid),
    .data_o(triangle)
  );

  // ---- Caches

  logic line_valid, line_error, line_done, fill_triangle;
  logic node_fill_ready, triangle_fill_ready;
  logic [EntryWidth-1:0] fill_entry;
  logic [LineWidth-1:0] line;
  logic [AddressWidth-1:0] node_number, triangle_number;
  logic [$clog2(NodeLines)-1:0] node_entry;
  logic [$clog2(TriangleLines)-1:0] triangle_entry;
  logic node_looking;
  logic node_miss_valid, node_miss_ready, triangle_miss_valid, triangle_miss_ready;

  fifo #(
    .Width(1 + ReadIdWidth + LineWidth),
    .Depth(2)
  ) u_lines (
    .clk_i,
    .rst_ni,
    .push_i(line_valid_i & line_ready_o),
    .data_i({line_error_i, line_id_i, line_i}),
    .space_o(line_ready_o),
    .pop_i(line_done),
    .valid_o(line_valid),
    .data_o({line_error, fill_triangle, fill_entry, line})
  );
  assign prefetch_fire = prefetch_valid & ~node_valid & node_ready;

  if (Clocks == 1) begin : gen_always
    assign step_o = 1'b1;
  end else begin : gen_step
    logic [Clocks-1:0] turn_q;

    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) turn_q <= Clocks'(1);
      else turn_q <= {turn_q[Clocks-2:0], turn_q[Clocks-1]};
    end
    assign step_o = turn_q[0];
  end

  line_cache #(
    .Lines(NodeLines),
    .Targets(Rays),
    .RayWidth(RayWidth)
  ) u_node_cache (
    .clk_i,
    .rst_ni,
    .invalidate_i,
    .valid_i(node_valid | prefetch_valid),
    .ready_o(node_ready),
    .demand_i(node_valid),
    .ray_i(node[RequestWidth-1 -: RayWidth]),
    .line_number_i(node_valid ? node[AddressWidth-1:0] : prefetch_line),
    .outstanding_o(node_looking),
    .miss_valid_o(node_miss_valid),
    .miss_ready_i(node_miss_ready),
    .miss_entry_o(node_entry),
    .miss_number_o(node_number),
    .fill_i(line_valid & ~fill_triangle),
    .fill_ready_o(node_fill_ready),
    .fill_entry_i(fill_entry[$clog2(NodeLines)-1:0]),
    .fill_line_i(line),
    .fill_error_i(line_error),
    .valid_o(node_o.valid),
    .ready_i(step_o),
    .ray_o(node_ctx_o),
    .line_o(node_o.line),
    .error_o(node_o.error)
  );
  line_cache #(
    .Lines(TriangleLines),
    .Targets(2 * Rays),
    .RayWidth(WhoWidth),
    .Width(KeptWidth)
  ) u_triangle_cache (
    .clk_i,
    .rst_ni,
    .invalidate_i,
    .valid_i(triangle_valid),
    .ready_o(triangle_ready),
    .demand_i(1'b1),
    .ray_i(triangle[AddressWidth +: WhoWidth]),
    .line_number_i(triangle[AddressWidth-1:0]),
    .outstanding_o(),
    .miss_valid_o(triangle_miss_valid),
    .miss_ready_i(triangle_miss_ready),
    .miss_entry_o(triangle_entry),
    .miss_number_o(triangle_number),
    .fill_i(line_valid & fill_triangle),
    .fill_ready_o(triangle_fill_ready),
    .fill_entry_i(fill_entry[$clog2(TriangleLines)-1:0]),
    .fill_line_i(line[KeptWidth-1:0]),
    .fill_error_i(line_error),
    .valid_o(triangle_o.valid),
    .ready_i(step_o),
    .ray_o(triangle_who),
    .line_o(triangle_kept),
    .error_o(triangle_o.error)
  );
  assign {triangle_o.exact, triangle_ctx_o} = (RayWidth + 1)'(triangle_who);
  assign {triangle_o.rank, triangle_o.line} =
      (RankWidth + TriangleWidth)'(triangle_kept);

  // ---- Misses, of both caches in turn

  localparam int unsigned CountWidth = $clog2(NodeLines + TriangleLines + 1);

  logic [MissWidth:0] out;
  logic out_ready, ask, ask_node, node_last_q;  // node_last_q: the last was a node's
  logic ask_q, done_q;  // events of the clock before
  logic [CountWidth-1:0] lines_q;  // lines requested and not in a cache yet

  assign node_miss_ready     = out_ready & (~triangle_miss_valid | ~node_last_q);
  assign ask_node            = node_miss_valid & node_miss_ready;
  assign triangle_miss_ready = out_ready & ~ask_node;
  assign ask                 = out_ready & (node_miss_valid | triangle_miss_valid);
  assign line_done           = line_valid & (fill_triangle ? triangle_fill_ready : node_fill_ready);
  assign outstanding_o       = (lines_q != '0) | ask_q | prefetch_valid | node_looking;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      {node_last_q, ask_q, done_q} <= '0;
      lines_q <= '0;
    end else begin
      if (ask) node_last_q <= ask_node;
      {ask_q, done_q} <= {ask, line_done};
      lines_q <= lines_q + CountWidth'(ask_q) - CountWidth'(done_q);
    end
  end

  fifo #(
    .Width(1 + MissWidth),
    .Depth(2)
  ) u_out (
    .clk_i,
    .rst_ni,
    .push_i(ask),
    .data_i(ask_node ? {1'b0, EntryWidth'(node_entry), node_number}
                     : {1'b1, EntryWidth'(triangle_entry), triangle_number}),
    .space_o(out_ready),
    .pop_i(read_valid_o & read_ready_i),
    .valid_o(read_valid_o),
    .data_o(out)
  );
  assign read_line_o = out[AddressWidth-1:0];
  assign read_id_o   = out[MissWidth -: ReadIdWidth];

endmodule
