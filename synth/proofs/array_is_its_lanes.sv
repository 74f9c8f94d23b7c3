// Claims about an array of four lanes: lane n receives slot n of every input and nothing else. Slot n of every output
// comes from lane n. counter_o is the sum of the lanes' events from reset to two clocks ago.
// opened_hit_test_array is the array with the lanes' inputs and outputs, and the counters, as additional outputs.
module array_is_its_lanes #(
  localparam int unsigned Lanes       = 4,
  localparam int unsigned TagWidth    = 2,
  localparam int unsigned Width       = 16,
  localparam int unsigned RecordWidth = hit_test_pkg::RecordWords * Width,
  localparam int unsigned TErrorWidth = hit_test_pkg::TErrorWidth,
  localparam int unsigned NumCounts   = hit_test_pkg::NumCounts,
  localparam int unsigned GivenWidth  = 5 + TagWidth + 3 * Width + RecordWidth,
  localparam int unsigned SaidWidth   = 7 + 2 * TagWidth + 4 * Width + TErrorWidth
) (
  input logic                         clk,
  input logic                         reset_n,
  input logic [Lanes-1:0]             valid,
  input logic [Lanes-1:0]             first,
  input logic [Lanes-1:0]             last,
  input logic [Lanes*TagWidth-1:0]    tag,
  input logic [Lanes*3*Width-1:0]     direction,
  input logic [Lanes*RecordWidth-1:0] record,
  input logic [Lanes-1:0]             take,
  input logic [3:0]                   select
);

  logic [Lanes-1:0] ready, valid_out, closed, found, point_valid;
  logic [Lanes*2-1:0] report;
  logic [Lanes*TagWidth-1:0] report_tag, tag_out;
  logic [Lanes*Width-1:0] t;
  logic [Lanes*TErrorWidth-1:0] t_error;
  logic [Lanes*3*Width-1:0] point;
  logic [5:0] counter;
  logic [6*NumCounts-1:0] counters;
  logic [Lanes*NumCounts-1:0] last_events;
  logic [Lanes*GivenWidth-1:0] given;
  logic [Lanes*SaidWidth-1:0] said;
  logic [Lanes*NumCounts-1:0] events;

  opened_hit_test_array dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .valid_i(valid),
    .ready_o(ready),
    .first_i(first),
    .last_i(last),
    .tag_i(tag),
    .direction_i(direction),
    .record_i(record),
    .valid_o(valid_out),
    .ready_i(take),
    .report_o(report),
    .report_tag_o(report_tag),
    .closed_o(closed),
    .found_o(found),
    .tag_o(tag_out),
    .t_o(t),
    .t_error_o(t_error),
    .point_valid_o(point_valid),
    .point_o(point),
    .count_select_i(select),
    .counter_o(counter),
    .counters(counters),
    .events_q(last_events),
    .\gen_lane[0].u_pipeline.given (given[0*GivenWidth+:GivenWidth]),
    .\gen_lane[1].u_pipeline.given (given[1*GivenWidth+:GivenWidth]),
    .\gen_lane[2].u_pipeline.given (given[2*GivenWidth+:GivenWidth]),
    .\gen_lane[3].u_pipeline.given (given[3*GivenWidth+:GivenWidth]),
    .\gen_lane[0].u_pipeline.said (said[0*SaidWidth+:SaidWidth]),
    .\gen_lane[1].u_pipeline.said (said[1*SaidWidth+:SaidWidth]),
    .\gen_lane[2].u_pipeline.said (said[2*SaidWidth+:SaidWidth]),
    .\gen_lane[3].u_pipeline.said (said[3*SaidWidth+:SaidWidth]),
    .\gen_lane[0].u_pipeline.counted (events[0*NumCounts+:NumCounts]),
    .\gen_lane[1].u_pipeline.counted (events[1*NumCounts+:NumCounts]),
    .\gen_lane[2].u_pipeline.counted (events[2*NumCounts+:NumCounts]),
    .\gen_lane[3].u_pipeline.counted (events[3*NumCounts+:NumCounts])
  );

  logic first_clock;
  initial first_clock = 1'b1;
  always_ff @(posedge clk) first_clock <= 1'b0;
  always_comb assume (!first_clock || !reset_n);

  for (genvar n = 0; n < Lanes; n++) begin : gen_lane
    always_comb begin
      assert (given[GivenWidth*n+:GivenWidth]
              == {reset_n, valid[n], first[n], last[n], tag[TagWidth*n+:TagWidth],
                  direction[3*Width*n+:3*Width], record[RecordWidth*n+:RecordWidth], take[n]});
      assert (said[SaidWidth*n+:SaidWidth]
              == {ready[n], valid_out[n], report[2*n+:2], report_tag[TagWidth*n+:TagWidth],
                  closed[n], found[n], tag_out[TagWidth*n+:TagWidth], t[Width*n+:Width],
                  t_error[TErrorWidth*n+:TErrorWidth], point_valid[n],
                  point[3*Width*n+:3*Width]});
    end
  end

  // ---- The sum of one kind of events over all lanes; the kind `counted` is arbitrary and constant

  (* anyconst *) logic [3:0] counted;
  logic [5:0] total;
  logic [Lanes*NumCounts-1:0] events_q;
  always_ff @(posedge clk) begin
    events_q <= reset_n ? events : '0;
    total    <= reset_n ? total + 6'(events_q[counted]) + 6'(events_q[NumCounts+counted])
                          + 6'(events_q[2*NumCounts+counted]) + 6'(events_q[3*NumCounts+counted])
                        : '0;
  end

  always_comb begin
    if (reset_n && !first_clock && counted < NumCounts) begin
      assert (last_events == events_q);
      assert (counters[6*counted+:6] == total);
      if (select == counted) assert (counter == total);
      cover (select == counted && counter == 6'd9);
    end
    if (select >= NumCounts) assert (counter == '0);
  end

endmodule
