// Claim, for any arithmetic: every test that the pipelined unit takes enters nearest_hit once, in order, with its tag,
// first_i and last_i. opened_hit_test_pipeline is the unit with the inputs of nearest_hit as outputs.
// nearest_hit_keeps_nearest and fifo_keeps_order prove the steps from nearest_hit to the results.
module pipeline_keeps_tags #(
  parameter int unsigned ExpWidth  = 5,
  parameter int unsigned FracWidth = 10,
  localparam int unsigned TagWidth = 2,
  localparam int unsigned Width    = 1 + ExpWidth + FracWidth
) (
  input logic                clk,
  input logic                reset_n,
  input logic                valid,
  input logic                first,
  input logic                last,
  input logic [TagWidth-1:0] tag,
  input logic                take
);

  // Clocks of the decision (1), the dot products and the division
  localparam int unsigned Latency = 1 + hit_test_pkg::DotLatency
                                    + hit_test_pkg::divide_latency(FracWidth);

  logic first_clock;
  initial first_clock = 1'b1;
  always_ff @(posedge clk) first_clock <= 1'b0;
  always_comb assume (!first_clock || !reset_n);

  logic ready, nearest_valid, nearest_first, nearest_last;
  logic [TagWidth-1:0] nearest_tag;

  opened_hit_test_pipeline dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .valid_i(valid),
    .ready_o(ready),
    .first_i(first),
    .last_i(last),
    .tag_i(tag),
    .direction_i('0),
    .record_i('0),
    .ready_i(take),
    .\u_nearest.valid_i (nearest_valid),
    .\u_nearest.first_i (nearest_first),
    .\u_nearest.last_i (nearest_last),
    .\u_nearest.tag_i (nearest_tag)
  );

  logic [Latency:1] taken;  // taken[n]: a test was taken n clocks ago
  logic [Latency*(TagWidth+2)-1:0] what;
  initial taken = '0;
  always_ff @(posedge clk) begin
    taken <= reset_n ? {taken[Latency-1:1], valid && ready} : '0;
    what <= {what[(Latency-1)*(TagWidth+2)-1:0], first, last, tag};
  end

  always_comb begin
    if (reset_n) begin
      assert (nearest_valid == taken[Latency]);
      if (taken[Latency]) begin
        assert ({nearest_first, nearest_last, nearest_tag}
                == what[Latency*(TagWidth+2)-1-:TagWidth+2]);
      end
      cover (nearest_valid && nearest_last && nearest_tag == '1);
    end
  end

endmodule
