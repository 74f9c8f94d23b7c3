// Exit of rays: detects that a ray has ended, and queues results.
//
// A ray has ended when it has no node, no leaf and no test left. Its context is free at once: its nearest hit waits
// in a queue for P, which comes PointDelay clocks later at most, before another ray in the context could have
// one. A ray's doubts and overflows leave before its end.
//
// A ray ends a clock at most, a result leaves a clock.
module ray_retire #(
  parameter int unsigned Rays = 64,
  localparam int unsigned RayWidth = $clog2(Rays),
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth,
  localparam int unsigned NodesWidth = ray_core_pkg::NodesWidth,
  localparam int unsigned TestsWidth = ray_core_pkg::TestsWidth,
  localparam int unsigned TErrorWidth = ray_core_pkg::TErrorWidth
) (
  input  logic                   clk_i,
  input  logic                   rst_ni,
  input  logic                   start_i,        // a ray is in a context
  input  logic [RayWidth-1:0]    start_ctx_i,
  input  logic [Rays-1:0]        busy_i,         // something is to be done for a context's ray
  // a ray ends, its context is free; what is known of it, in the same clock
  output logic                   ending_o,
  output logic [RayWidth-1:0]    ending_ctx_o,
  input  logic [31:0]            ending_tag_i,
  input  logic                   ending_found_i,
  input  logic [31:0]            ending_triangle_i,
  input  logic [31:0]            ending_t_i,
  input  logic [TErrorWidth-1:0] ending_t_error_i,
  input  logic [TestsWidth-1:0]  ending_tests_i,
  input  logic [2:0]             ending_error_i,
  // the P of a context's last ray, in the clock after
  output logic [RayWidth-1:0]    point_ctx_o,
  input  logic [95:0]            point_i,
  // doubts and overflows
  input  logic                   doubt_valid_i,
  input  logic [31:0]            doubt_tag_i,
  input  logic [31:0]            doubt_triangle_i,
  output logic                   doubt_fire_o,
  input  logic                   overflow_valid_i,
  input  logic [31:0]            overflow_tag_i,
  input  logic [AddressWidth-1:0] overflow_line_i,
  input  logic [NodesWidth-1:0]  overflow_nodes_i,
  output logic                   overflow_fire_o,
  // results
  output logic                   result_valid_o,
  input  logic                   result_ready_i,
  output ray_core_pkg::result_t  result_o
);

  localparam int unsigned PointDelay = hit_test_pkg::divide_latency(23) + 4;
  localparam int unsigned Depth = PointDelay + 4;  // for an end a clock
  localparam int unsigned EndWidth = 32 + 1 + 32 + 32 + TErrorWidth + TestsWidth + 3;

  // ---- The end of a ray

  logic [Rays-1:0] active_q;  // in its context, and its end not noticed
  logic some, space;

  rr_arbiter #(
    .Width(Rays)
  ) u_pick (
    .requests_i(active_q & ~busy_i),
    .start_i('0),
    .valid_o(some),
    .index_o(ending_ctx_o)
  );
  assign ending_o = some & space;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      active_q <= '0;
    end else begin
      if (start_i) active_q[start_ctx_i] <= 1'b1;
      if (ending_o) active_q[ending_ctx_o] <= 1'b0;
    end
  end

  // ---- What is known of it, and P: as many points at most as there are ends

  logic [PointDelay:0] pointing_q;
  logic end_valid, end_fire, unused_valid, unused_space;
  logic [EndWidth-1:0] end_words;
  logic [95:0] end_point;
  logic [31:0] end_tag, end_triangle, end_t;
  logic [TErrorWidth-1:0] end_t_error;
  logic [TestsWidth-1:0] end_tests;
  logic [2:0] end_error;
  logic end_found;

  ram_fifo #(
    .Width(EndWidth),
    .Depth(Depth)
  ) u_ends (
    .clk_i,
    .rst_ni,
    .push_i(ending_o),
    .data_i({ending_tag_i, ending_found_i, ending_triangle_i, ending_t_i, ending_t_error_i,
             ending_tests_i, ending_error_i}),
    .space_o(space),
    .pop_i(end_fire),
    .valid_o(unused_valid),
    .data_o(end_words)
  );
  assign {end_tag, end_found, end_triangle, end_t, end_t_error, end_tests, end_error} = end_words;

  delay_line #(
    .Width(RayWidth),
    .Depth(PointDelay)
  ) u_pointing (
    .clk_i,
    .enable_i(1'b1),
    .data_i(ending_ctx_o),
    .data_o(point_ctx_o)
  );
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) pointing_q <= '0;
    else pointing_q <= {pointing_q[PointDelay-1:0], ending_o};
  end
  ram_fifo #(
    .Width(96),
    .Depth(Depth)
  ) u_points (
    .clk_i,
    .rst_ni,
    .push_i(pointing_q[PointDelay]),
    .data_i(point_i),
    .space_o(unused_space),
    .pop_i(end_fire),
    .valid_o(end_valid),
    .data_o(end_point)
  );

  // ---- Results

  logic load;

  assign load            = ~result_valid_o | result_ready_i;
  assign doubt_fire_o    = load & doubt_valid_i;
  assign overflow_fire_o = load & overflow_valid_i & ~doubt_valid_i;
  assign end_fire        = load & end_valid & ~doubt_valid_i & ~overflow_valid_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) result_valid_o <= 1'b0;
    else if (load) result_valid_o <= doubt_valid_i | overflow_valid_i | end_valid;
  end
  always_ff @(posedge clk_i) begin
    if (load) begin
      result_o.kind     <= doubt_valid_i ? ray_core_pkg::ResultDoubt
                         : overflow_valid_i ? ray_core_pkg::ResultOverflow
                         : ray_core_pkg::ResultEnd;
      result_o.tag      <= doubt_valid_i ? doubt_tag_i
                         : overflow_valid_i ? overflow_tag_i : end_tag;
      result_o.found    <= end_found & ~doubt_valid_i & ~overflow_valid_i;
      result_o.triangle <= doubt_valid_i ? doubt_triangle_i : end_triangle;
      result_o.t        <= end_t;
      result_o.t_error  <= end_t_error;
      result_o.point    <= end_point;
      result_o.tests    <= end_tests;
      result_o.error    <= end_error;
      result_o.line     <= overflow_line_i;
      result_o.nodes    <= overflow_nodes_i;
    end
  end

endmodule
