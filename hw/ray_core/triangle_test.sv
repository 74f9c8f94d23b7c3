// Triangle pipeline: set_up_unit's record of a triangle, then hit_test_pipeline's verdict on it; one a clock.
//
// Nothing that comes in is stalled; an output is there for the clock that says so. The ray is given by its context:
// origin_i and both ids in the clock after the triangle came, its direction in that after direction_ctx_o asked for it.
//
// Every test is a burst of its own. A hit's P is there later than its verdict, in the order of the hits: up to
// divide_latency + 4 clocks after it.
module triangle_test #(
  parameter int unsigned Rays  = 64,
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned RayWidth = $clog2(Rays),
  localparam int unsigned PlaneErrorWidth = set_up_pkg::PlaneErrorWidth
) (
  input  logic                       clk_i,
  input  logic                       rst_ni,
  input  logic [RayWidth-1:0]        ctx_i,
  // verilator lint_off UNUSEDSIGNAL
  // Ranks are exact_resolver's, and so are lines that are `exact`.
  input  ray_core_pkg::triangle_line_t triangle_i,  // with an error it counts for nothing
  // verilator lint_on UNUSEDSIGNAL
  input  logic [95:0]                origin_i,
  input  logic [31:0]                skip_id_i,   // triangles that count for nothing
  input  logic [31:0]                source_id_i,
  output logic [RayWidth-1:0]        direction_ctx_o,
  input  logic [95:0]                direction_i,
  output logic [RayWidth-1:0]        ctx_o,
  output ray_core_pkg::verdict_t     verdict_o
);

  if (ray_core_pkg::VerdictErrorWidth != PlaneErrorWidth
      || ray_core_pkg::VerdictErrorWidth != hit_test_pkg::TErrorWidth) begin : gen_check
    $error("triangle_test: expected VerdictErrorWidth to be set_up_pkg's and hit_test_pkg's");
  end

  // ---- Set up

  logic [hit_test_pkg::RecordWords*32-1:0] set_record;
  logic [PlaneErrorWidth-1:0] set_normal_error, set_distance_error;
  logic [set_up_pkg::Latency+1:0] setting_q;
  logic [ray_core_pkg::TriangleWidth-1:0] first_q, triangle_q;
  logic [95:0] origin_q;
  logic [RayWidth-1:0] first_ctx_q, ctx_q, set_ctx_q;
  logic [31:0] index, early_triangle, set_triangle_q;
  logic error_q, skipped_q, early_skipped, set_skipped_q;

  assign index = first_q[ray_core_pkg::TriangleIndex+:32];

  always_ff @(posedge clk_i) begin
    {first_q, first_ctx_q, error_q} <= {triangle_i.line, ctx_i, triangle_i.error};
    {triangle_q, ctx_q, origin_q}   <= {first_q, first_ctx_q, origin_i};
    skipped_q <= error_q | (index == skip_id_i) | (index == source_id_i);
  end

  set_up_unit #(
    .Arith(Arith),
    .Adder(Adder)
  ) u_set_up (
    .clk_i,
    .origin_i(origin_q),
    .corners_i(triangle_q[ray_core_pkg::TriangleCorners +: 9*32]),
    .record_o(set_record),
    .normal_error_o(set_normal_error),
    .distance_error_o(set_distance_error)
  );
  delay_line #(
    .Width(RayWidth + 32 + 1),
    .Depth(set_up_pkg::Latency - 1)
  ) u_sideband_set_up (
    .clk_i,
    .enable_i(1'b1),
    .data_i({ctx_q, triangle_q[ray_core_pkg::TriangleIndex+:32], skipped_q}),
    .data_o({direction_ctx_o, early_triangle, early_skipped})
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) setting_q <= '0;
    else setting_q <= {setting_q[set_up_pkg::Latency:0], triangle_i.valid & ~triangle_i.exact};
  end
  always_ff @(posedge clk_i) begin
    {set_ctx_q, set_triangle_q, set_skipped_q} <= {direction_ctx_o, early_triangle, early_skipped};
  end

  // ---- Test

  localparam int unsigned TagWidth = 2 * PlaneErrorWidth + 1 + RayWidth + 32;

  logic unused_ready, word_valid, closed, found, point_valid;
  hit_test_pkg::report_e report;
  logic [TagWidth-1:0] tag, unused_tag;
  logic [hit_test_pkg::NumCounts-1:0] unused_events;

  hit_test_pipeline #(
    .Arith(Arith),
    .Adder(Adder),
    .TagWidth(TagWidth),
    .Single(1'b1)
  ) u_tests (
    .clk_i,
    .rst_ni,
    .valid_i(setting_q[set_up_pkg::Latency+1]),
    .ready_o(unused_ready),  // always, as results are always taken
    .first_i(1'b1),
    .last_i(1'b1),
    .tag_i({set_normal_error, set_distance_error, set_skipped_q, set_ctx_q, set_triangle_q}),
    .direction_i,
    .record_i(set_record),
    .valid_o(word_valid),
    .ready_i(1'b1),
    .report_o(report),
    .report_tag_o(tag),
    .closed_o(closed),
    .found_o(found),
    .tag_o(unused_tag),
    .t_o(verdict_o.t),
    .t_error_o(verdict_o.t_error),
    .point_valid_o(point_valid),
    .point_o(verdict_o.point),
    .events_o(unused_events)
  );

  assign verdict_o.valid       = word_valid & closed;
  assign verdict_o.found       = found;
  assign verdict_o.doubt       = report == hit_test_pkg::ReportDoubt;
  assign verdict_o.point_valid = word_valid & point_valid;
  assign {verdict_o.normal_error, verdict_o.distance_error, verdict_o.is_skipped, ctx_o,
          verdict_o.triangle} = tag;

endmodule
