// Triangle pipeline: set_up_unit's record of a triangle, then hit_test_pipeline's verdict on it; one a clock.
//
// Nothing that comes in is stalled; an output is there for the clock that says so. The ray is given by its context:
// origin_i and skip_id_i in the clock after the triangle came, its direction in that after direction_ctx_o asked for it.
//
// Every test is a burst of its own. closed_o: one is over, of ctx_o and triangle_o: a doubt_o, a sure hit
// (found_o), or a miss. A hit's P is there later, point_valid_o, in the order of the hits: up to
// divide_latency + 4 clocks after it.
module triangle_test #(
  parameter int unsigned Rays  = 64,
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned RayWidth = $clog2(Rays),
  localparam int unsigned TriangleWidth = ray_core_pkg::TriangleWidth,
  localparam int unsigned PlaneErrorWidth = set_up_pkg::PlaneErrorWidth
) (
  input  logic                       clk_i,
  input  logic                       rst_ni,
  input  logic                       valid_i,
  input  logic [RayWidth-1:0]        ctx_i,
  input  logic [TriangleWidth-1:0]   triangle_i,  // a triangle line
  input  logic [95:0]                origin_i,
  input  logic [31:0]                skip_id_i,   // a triangle that counts for nothing
  input  logic                       error_i,     // nor does this one: its line came with an error
  output logic [RayWidth-1:0]        direction_ctx_o,
  input  logic [95:0]                direction_i,
  output logic                       closed_o,
  output logic [RayWidth-1:0]        ctx_o,
  output logic [31:0]                triangle_o,
  output logic                       is_skipped_o,
  output logic                       doubt_o,
  output logic                       found_o,
  output logic [31:0]                t_o,  // off by t_error_o and the plane's: see set_up_pkg
  output logic [hit_test_pkg::TErrorWidth-1:0] t_error_o,
  output logic [PlaneErrorWidth-1:0] normal_error_o,
  output logic [PlaneErrorWidth-1:0] distance_error_o,
  output logic                       point_valid_o,
  output logic [95:0]                point_o
);

  // ---- Set up

  logic [hit_test_pkg::RecordWords*32-1:0] set_record;
  logic [PlaneErrorWidth-1:0] set_normal_error, set_distance_error;
  logic [set_up_pkg::Latency:0] setting_q;
  logic [TriangleWidth-1:0] triangle_q;
  logic [RayWidth-1:0] ctx_q, set_ctx_q;
  logic [31:0] index, early_triangle, set_triangle_q;
  logic error_q, early_skipped, set_skipped_q;

  always_ff @(posedge clk_i) begin
    triangle_q <= triangle_i;
    ctx_q      <= ctx_i;
    error_q    <= error_i;
  end

  assign index = triangle_q[ray_core_pkg::TriangleIndex+:32];

  set_up_unit #(
    .Arith(Arith),
    .Adder(Adder)
  ) u_set_up (
    .clk_i,
    .origin_i,
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
    .data_i({ctx_q, index, error_q | (index == skip_id_i)}),
    .data_o({direction_ctx_o, early_triangle, early_skipped})
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) setting_q <= '0;
    else setting_q <= {setting_q[set_up_pkg::Latency-1:0], valid_i};
  end
  always_ff @(posedge clk_i) begin
    {set_ctx_q, set_triangle_q, set_skipped_q} <= {direction_ctx_o, early_triangle, early_skipped};
  end

  // ---- Test

  localparam int unsigned TagWidth = 2 * PlaneErrorWidth + 1 + RayWidth + 32;

  logic unused_ready, word_valid, closed, point_valid;
  hit_test_pkg::report_e report;
  logic [TagWidth-1:0] report_tag, found_tag, tag;
  logic [hit_test_pkg::NumCounts-1:0] unused_events;

  hit_test_pipeline #(
    .Arith(Arith),
    .Adder(Adder),
    .TagWidth(TagWidth),
    .AlwaysReady(1'b1)
  ) u_tests (
    .clk_i,
    .rst_ni,
    .valid_i(setting_q[set_up_pkg::Latency]),
    .ready_o(unused_ready),  // always, as results are always taken
    .first_i(1'b1),
    .last_i(1'b1),
    .tag_i({set_normal_error, set_distance_error, set_skipped_q, set_ctx_q, set_triangle_q}),
    .direction_i,
    .record_i(set_record),
    .valid_o(word_valid),
    .ready_i(1'b1),
    .report_o(report),
    .report_tag_o(report_tag),
    .closed_o(closed),
    .found_o,
    .tag_o(found_tag),
    .t_o,
    .t_error_o,
    .point_valid_o(point_valid),
    .point_o,
    .events_o(unused_events)
  );

  assign closed_o      = word_valid & closed;
  assign doubt_o       = report == hit_test_pkg::ReportDoubt;
  assign point_valid_o = word_valid & point_valid;
  assign tag           = found_o ? found_tag : report_tag;
  assign {normal_error_o, distance_error_o, is_skipped_o, ctx_o, triangle_o} = tag;

endmodule
