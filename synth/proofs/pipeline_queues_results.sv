// Claim: the pipelined unit packs its results into words of a queue and unpacks them correctly. The queue is replaced
// by a wire. Each result port then equals an output of nearest_hit or of the dividers of P, and a result is valid
// exactly when one of these outputs is valid. fifo_keeps_order proves that a queue keeps words and their order.
module pipeline_queues_results #(
  parameter int unsigned ExpWidth  = 5,
  parameter int unsigned FracWidth = 10,
  localparam int unsigned TagWidth = 2,
  localparam int unsigned Width    = 1 + ExpWidth + FracWidth,
  localparam int unsigned TErrorWidth = hit_test_pkg::TErrorWidth
) (
  input logic                clk,
  input logic                reset_n,
  input logic                valid_in,
  input logic                first,
  input logic                last,
  input logic [TagWidth-1:0] tag,
  input logic                take
);

  logic [$bits(hit_test_pkg::report_e)-1:0] report_out;
  logic [1:0] report;
  logic ready, valid, closed_out, found_out, point_valid_out, closed, found, point_valid;
  logic [TagWidth-1:0] report_tag_out, tag_out, report_tag, nearest_tag;
  logic [Width-1:0] t_out, t;
  logic [TErrorWidth-1:0] t_error_out, nearest_t_error;
  logic [3*Width-1:0] point_out, point;

  opened_hit_test_pipeline dut (  // the unit in any state, with the outputs of nearest_hit and the dividers
    .clk_i(clk),
    .rst_ni(reset_n),
    .valid_i(valid_in),
    .first_i(first),
    .last_i(last),
    .tag_i(tag),
    .direction_i('0),
    .record_i('0),
    .ready_o(ready),
    .valid_o(valid),
    .ready_i(take),
    .report_o(report_out),
    .report_tag_o(report_tag_out),
    .closed_o(closed_out),
    .found_o(found_out),
    .tag_o(tag_out),
    .t_o(t_out),
    .t_error_o(t_error_out),
    .point_valid_o(point_valid_out),
    .point_o(point_out),
    .\u_nearest.report_o (report),
    .\u_nearest.report_tag_o (report_tag),
    .\u_nearest.closed_o (closed),
    .\u_nearest.found_o (found),
    .\u_nearest.tag_o (nearest_tag),
    .\u_nearest.t_o (t),
    .\u_nearest.t_error_o (nearest_t_error),
    .point_valid(point_valid),
    .point(point)
  );

  always_comb begin
    assert (ready);
    assert (valid == (report != hit_test_pkg::ReportNone || closed || point_valid));
    assert ({report_out, report_tag_out} == {report, report_tag});
    assert ({closed_out, found_out, tag_out, t_out, t_error_out}
            == {closed, found, nearest_tag, t, nearest_t_error});
    assert ({point_valid_out, point_out} == {point_valid, point});
  end

endmodule
