// Claims about nearest_hit, for any tests: after any sure hit of a burst, the kept hit is not farther than this hit. A
// burst has a nearest hit if and only if the burst had a sure hit. When a sure hit follows a kept hit, the hit that is
// not kept is reported if and only if the distances of both hits differ by at most the sum of their errors.
module nearest_hit_keeps_nearest #(
  parameter int unsigned ExpWidth  = 5,
  parameter int unsigned FracWidth = 10,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input logic             clk,
  input logic             valid,
  input logic             first,
  input logic             last,
  input logic             hit,
  input logic             doubt,
  input logic             choose,   // watch this test
  input logic [3:0]       tag,
  input logic [Width-1:0] t,
  input logic [3:0]       t_error
);

  logic reset_n;
  initial reset_n = 1'b0;
  always_ff @(posedge clk) reset_n <= 1'b1;

  logic sure, closed, found;
  logic [1:0] report;
  logic [3:0] report_tag, nearest_tag, nearest_t_error, payload;
  logic [Width-1:0] nearest_t;

  nearest_hit #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .TagWidth(4),
    .PayloadWidth(4)
  ) dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .valid_i(valid),
    .first_i(first),
    .last_i(last),
    .hit_i(hit),
    .doubt_i(doubt),
    .tag_i(tag),
    .t_i(t),
    .t_error_i(t_error),
    .payload_i(tag),
    .sure_hit_o(sure),
    .report_o(report),
    .report_tag_o(report_tag),
    .closed_o(closed),
    .found_o(found),
    .tag_o(nearest_tag),
    .t_o(nearest_t),
    .t_error_o(nearest_t_error),
    .payload_o(payload)
  );

  // Assumption: first and last frame bursts as the header of hit_test_pipeline requires
  logic in_burst;
  initial in_burst = 1'b0;
  always_ff @(posedge clk) begin
    if (!reset_n) in_burst <= 1'b0;
    else if (valid) in_burst <= !last;
  end
  always_comb assume (!valid || first == !in_burst);
  // Assumption: what hit_decision guarantees, proven in decision_follows_edges
  localparam logic [3:0] MaxError = 4'(hit_test_pkg::max_grazing(FracWidth));
  always_comb assume (!hit || (!doubt && t_error <= MaxError));

  // any: the burst had a sure hit; watched: it had the watched hit; was_*: the last test, and the hit kept before it
  logic any, watched, taken, was_sure, was_have, was_doubt, was_hit, was_last;
  logic [3:0] was_tag, was_best_tag;
  logic [Width-1:0] watched_t, was_t, was_best;
  logic [3:0] was_error, was_best_error;
  initial {any, watched, taken} = '0;
  always_ff @(posedge clk) begin
    taken <= reset_n && valid;
    if (!reset_n) begin
      {any, watched} <= '0;
    end else if (valid) begin
      any <= sure || (any && !first);
      watched <= (sure && choose) || (watched && !first);
      if (sure && choose) watched_t <= t;
      was_sure <= sure;
      was_have <= found && !first;
      {was_doubt, was_hit, was_last} <= {doubt, hit, last};
      {was_t, was_error, was_tag} <= {t, t_error, tag};
      {was_best, was_best_error, was_best_tag} <= {nearest_t, nearest_t_error, nearest_tag};
    end
  end

  logic [Width+16:0] margin, apart;
  assign margin = ((Width + 17)'(64) << was_error) + ((Width + 17)'(64) << was_best_error);
  assign apart = (was_t > was_best) ? (Width + 17)'(was_t) - (Width + 17)'(was_best)
                                    : (Width + 17)'(was_best) - (Width + 17)'(was_t);

  always_comb begin
    if (reset_n) begin
      if (in_burst || taken) assert (found == any);
      if ((in_burst || taken) && any) begin
        assert (!nearest_t[Width-1] && nearest_t_error <= MaxError && payload == nearest_tag);
      end
      if ((in_burst || taken) && watched) assert (any && nearest_t <= watched_t);
      if (taken && was_sure && was_have) assert ((report == 2'd2) == (apart <= margin));
      if (taken && !was_sure) assert (report == ((was_doubt || was_hit) ? 2'd1 : 2'd0));
      if (taken && report != 2'd2) assert (report_tag == was_tag);
      if (taken && report == 2'd2) begin
        assert ({report_tag, nearest_tag} == {was_tag, was_best_tag}
                || {report_tag, nearest_tag} == {was_best_tag, was_tag});
      end
      if (!taken) assert (report == 2'd0);
      assert (closed == (taken && was_last));
      cover (taken && closed && found && watched && nearest_t < watched_t);
      cover (taken && report == 2'd2 && report_tag != nearest_tag);
    end
  end

endmodule
