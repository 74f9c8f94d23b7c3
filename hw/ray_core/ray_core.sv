// Ray core: rays in, nearest hits out, or, without Exact, nearest sure hits and doubts; it traverses a tree in memory.
//
// Rays and results: valid/ready. A ray's direction is scaled: the largest component is in [1, 2). Hits at t >= `t_max`, in exact arithmetic, and on triangles `skip_id`
// and `source_id`, the one that it leaves, do not count. With `any_hit` it ends at its first sure hit, with `no_cull` it enters all boxes. Words about rays come
// mixed, by tag, and rays end in any order: see ray_core_pkg::result_e. With an error they say nothing, see error_e.
// Memory: reads of lines by number, valid/ready, each with an id. Lines come back with it, in any order, valid/ready;
// with line_error_i, not to be believed: it is read again for the next ray. Some are prefetched: outstanding_o may be high
// when the last ray has ended. Memory may change, and invalidate_i be high, while no ray is here and outstanding_o is low.
// Throughput: a node and a triangle in Clocks clocks, out of the caches; a line of what they lack.
module ray_core #(
  parameter int unsigned Rays  = 64,  // of the table; a power of two
  parameter int unsigned Depth = 8,   // groups on a ray's own stack
  parameter int unsigned Levels = ray_core_pkg::Levels,  // with those shared, see traversal
  parameter int unsigned NodeLines     = 256,  // of the cache of nodes; a power of two
  parameter int unsigned TriangleLines = 256,  // of the cache of triangles; likewise
  parameter int unsigned Clocks = 1,  // of a node and a triangle: pipelines; or 7 or more, in turns
  parameter int unsigned Exact = 0,  // exact_units, for which triangles have ranks; 0: doubts leave
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned RayWidth = $clog2(Rays),
  localparam int unsigned ReadIdWidth = 1 + $clog2(
      NodeLines > TriangleLines ? NodeLines : TriangleLines)
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    invalidate_i,  // memory has changed: see above
  output logic                    outstanding_o,
  input  logic                    abort_i,  // the rays that are here
  input  logic [ray_core_pkg::AddressWidth-1:0] lines_i,  // of memory; 0: 2**AddressWidth
  input  logic                    ray_valid_i,
  output logic                    ray_ready_o,
  input  ray_core_pkg::ray_t        ray_i,
  output logic                    result_valid_o,
  input  logic                    result_ready_i,
  output ray_core_pkg::result_t    result_o,
  output logic                    read_valid_o,
  input  logic                    read_ready_i,
  output logic [ray_core_pkg::AddressWidth-1:0] read_line_o,
  output logic [ReadIdWidth-1:0]  read_id_o,
  input  logic                    line_valid_i,
  output logic                    line_ready_o,
  input  logic [ReadIdWidth-1:0]  line_id_i,
  input  logic [ray_core_pkg::LineWidth-1:0] line_i,
  input  logic                    line_error_i,
  output logic [ray_core_pkg::NumEvents-1:0] events_o  // of the clock before, see event_e
);
  logic start_fire, triangle_ready, step, ending, doubt_fire;
  logic [RayWidth-1:0] start_ctx, node_ctx, triangle_ctx, node_line_ctx, triangle_line_ctx;
  logic [RayWidth-1:0] box_ctx, verdict_ctx, ending_ctx, end_ctx, point_ctx;
  logic [Rays-1:0] busy;
  logic [30:0] t_max;
  logic [95:0] end_point;
  logic [1:0] reads;
  logic [6:0] events;
  ray_core_pkg::start_t start;
  ray_core_pkg::request_t node, prefetch;
  ray_core_pkg::triangle_request_t triangle;
  ray_core_pkg::node_line_t node_line;
  ray_core_pkg::triangle_line_t triangle_line;
  ray_core_pkg::boxes_t boxes;
  ray_core_pkg::verdict_t verdict;
  ray_core_pkg::doubt_t doubt;
  ray_core_pkg::end_t ended;

  traversal_subsystem #(
    .Rays(Rays),
    .Depth(Depth),
    .Levels(Levels),
    .Exact(Exact),
    .Arith(Arith),
    .Adder(Adder)
  ) u_traversal (
    .clk_i,
    .rst_ni,
    .abort_i,
    .lines_i,
    .start_ctx_i(start_ctx),
    .start_i(start),
    .start_fire_o(start_fire),
    .box_ctx_i(box_ctx),
    .boxes_i(boxes),
    .verdict_ctx_i(verdict_ctx),
    .verdict_i(verdict),
    .node_ctx_o(node_ctx),
    .node_o(node),
    .prefetch_o(prefetch),
    .triangle_ctx_o(triangle_ctx),
    .triangle_o(triangle),
    .triangle_ready_i(triangle_ready),
    .node_line_ctx_i(node_line_ctx),
    .node_error_i(node_line.valid & node_line.error),
    .t_max_o(t_max),
    .triangle_line_ctx_i(triangle_line_ctx),
    .triangle_line_i(triangle_line),
    .busy_o(busy),
    .doubt_o(doubt),
    .doubt_fire_i(doubt_fire),
    .events_o(events),
    .end_ctx_i(end_ctx),
    .end_o(ended),
    .point_ctx_i(point_ctx),
    .point_o(end_point)
  );

  memory_subsystem #(
    .Rays(Rays),
    .NodeLines(NodeLines),
    .TriangleLines(TriangleLines),
    .Exact(Exact != 0),
    .Clocks(Clocks)
  ) u_memory (
    .clk_i,
    .rst_ni,
    .invalidate_i,
    .outstanding_o,
    .node_ctx_i(node_ctx),
    .node_i(node),
    .prefetch_i(prefetch),
    .triangle_ctx_i(triangle_ctx),
    .triangle_i(triangle),
    .triangle_ready_o(triangle_ready),
    .read_valid_o,
    .read_ready_i,
    .read_line_o,
    .read_id_o,
    .line_valid_i,
    .line_ready_o,
    .line_id_i,
    .line_i,
    .line_error_i,
    .step_o(step),
    .node_ctx_o(node_line_ctx),
    .node_o(node_line),
    .triangle_ctx_o(triangle_line_ctx),
    .triangle_o(triangle_line)
  );

  intersection_subsystem #(
    .Rays(Rays),
    .Clocks(Clocks),
    .Arith(Arith),
    .Adder(Adder)
  ) u_intersection (
    .clk_i,
    .rst_ni,
    .ray_valid_i,
    .ray_ready_o,
    .ray_i,
    .start_ctx_o(start_ctx),
    .start_o(start),
    .start_fire_i(start_fire),
    .ending_i(ending),
    .ending_ctx_i(ending_ctx),
    .step_i(step),
    .node_ctx_i(node_line_ctx),
    .node_i(node_line),
    .t_max_i(t_max),
    .triangle_ctx_i(triangle_line_ctx),
    .triangle_i(triangle_line),
    .box_ctx_o(box_ctx),
    .boxes_o(boxes),
    .verdict_ctx_o(verdict_ctx),
    .verdict_o(verdict)
  );

  ray_retire #(
    .Rays(Rays)
  ) u_retire (
    .clk_i,
    .rst_ni,
    .start_i(start_fire),
    .start_ctx_i(start_ctx),
    .busy_i(busy),
    .ending_o(ending),
    .ending_ctx_o(ending_ctx),
    .end_ctx_o(end_ctx),
    .end_i(ended),
    .point_ctx_o(point_ctx),
    .point_i(end_point),
    .doubt_i(doubt),
    .doubt_fire_o(doubt_fire),
    .result_valid_o,
    .result_ready_i,
    .result_o
  );

  assign reads = {2{read_valid_o}} & {~read_ready_i, read_ready_i};

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) events_o <= '0;
    else events_o <= {events[6], reads, events[5:0], node_line.valid, ending};
  end

endmodule
