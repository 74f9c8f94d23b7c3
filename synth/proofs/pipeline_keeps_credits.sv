// Claims, from reset on, for any arithmetic, any tests and any back-pressure: the pipelined unit pushes no result into
// a full queue. An offered result holds, with its data, until it is taken. opened_hit_test_pipeline is the unit with
// its valid bits and its queue's registers as outputs.
module pipeline_keeps_credits #(
  parameter int unsigned ExpWidth  = 5,
  parameter int unsigned FracWidth = 10,
  localparam int unsigned TagWidth = 1,
  localparam int unsigned Width    = 1 + ExpWidth + FracWidth
) (
  input logic                clk,
  input logic                valid,
  input logic                first,
  input logic                last,
  input logic [TagWidth-1:0] tag,
  input logic                take  // ready for results
);

  localparam int unsigned Dot     = hit_test_pkg::DotLatency;
  localparam int unsigned Divide  = hit_test_pkg::divide_latency(FracWidth);
  localparam int unsigned Latency = hit_test_pkg::point_latency(FracWidth);
  localparam int unsigned Depth   = Latency + 2;
  localparam int unsigned IndexWidth = $clog2(Depth);
  localparam int unsigned CountWidth = $clog2(Depth + 1);
  localparam int unsigned OutWidth = 2 + TagWidth + 2 + TagWidth + Width + 4 + 1 + 3 * Width;

  logic reset_n;  // low for the first clock
  initial reset_n = 1'b0;
  always_ff @(posedge clk) reset_n <= 1'b1;

  logic ready, offered, closed, point_valid, push;
  logic [1:0] report;
  logic [Dot-1:0] test_q;
  logic decided_q;
  logic [Divide-1:0] dividing_q, point_q;
  logic [CountWidth-1:0] count_q;
  logic [IndexWidth-1:0] read_q, write_q;
  logic [OutWidth-1:0] out;

  (* anyseq *) logic [3*Width-1:0] direction;
  (* anyseq *) logic [16*Width-1:0] polygon_record;

  opened_hit_test_pipeline dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .valid_i(valid),
    .ready_o(ready),
    .first_i(first),
    .last_i(last),
    .tag_i(tag),
    .direction_i(direction),
    .record_i(polygon_record),
    .valid_o(offered),
    .ready_i(take),
    .report_o(out[0+:2]),
    .report_tag_o(out[2+:TagWidth]),
    .closed_o(out[2+TagWidth]),
    .found_o(out[3+TagWidth]),
    .tag_o(out[4+TagWidth+:TagWidth]),
    .t_o(out[4+2*TagWidth+:Width]),
    .t_error_o(out[4+2*TagWidth+Width+:4]),
    .point_valid_o(out[8+2*TagWidth+Width]),
    .point_o(out[9+2*TagWidth+Width+:3*Width]),
    .test_q(test_q),
    .decided_q(decided_q),
    .dividing_q(dividing_q),
    .report(report),
    .closed(closed),
    .point_q(point_q),
    .\u_results.push_i (push),
    .\u_results.count_q (count_q),
    .\u_results.read_q (read_q),
    .\u_results.write_q (write_q)
  );

  // Bit k: a test taken k clocks ago may still produce a word of results
  logic [Latency-1:1] on_its_way;
  assign on_its_way = {point_q, report != 2'd0 || closed, dividing_q, decided_q, test_q};

  // Clocks since the last test was taken, saturating at Latency, when nothing is in flight
  logic [CountWidth-1:0] since;
  always_ff @(posedge clk) begin
    if (!reset_n) since <= CountWidth'(Latency);
    else if (valid && ready) since <= CountWidth'(1);
    else if (since != CountWidth'(Latency)) since <= since + 1'b1;
  end

  logic [CountWidth:0] unwrapped;
  assign unwrapped = (CountWidth + 1)'(read_q) + (CountWidth + 1)'(count_q);

  logic waiting;
  logic [OutWidth-1:0] out_before;
  initial waiting = 1'b0;
  always_ff @(posedge clk) begin
    waiting <= reset_n && offered && !take;
    out_before <= out;
  end

  always_comb begin
    if (reset_n) begin
      assert (!push || count_q < CountWidth'(Depth));
      if (waiting) assert (offered && out == out_before);

      // Invariants: the queue holds at most two words, plus one for each clock since a test was taken
      assert (since != '0 && since <= CountWidth'(Latency));
      for (int unsigned k = 1; k < Latency; k++) begin
        assert (!on_its_way[k] || since <= CountWidth'(k));
      end
      assert (count_q <= since + CountWidth'(2));
      assert (ready == (count_q < CountWidth'(3)));
      assert (offered == (count_q != '0));
      assert (read_q < Depth && write_q < Depth);
      assert (unwrapped == (CountWidth + 1)'(write_q)
              + (write_q < read_q || count_q == CountWidth'(Depth) ? Depth : 0));
    end
  end

endmodule
