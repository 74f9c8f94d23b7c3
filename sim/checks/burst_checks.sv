// The framing of bursts at a hit-test pipeline. The user sends complete bursts: first_i only in a burst's first test,
// last_i only in its last test, one direction per burst. The unit closes no more bursts than it took. It returns at
// most one point for each closed burst that has a nearest hit.
module burst_checks #(
  parameter int unsigned DirectionWidth = 96
) (
  input logic                      clk_i,
  input logic                      rst_ni,
  input logic                      in_fire,      // a test is taken at this clock edge
  input logic                      first_i,
  input logic                      last_i,
  input logic [DirectionWidth-1:0] direction_i,
  input logic                      out_fire,     // a result is taken at this clock edge
  input logic [1:0]                report,
  input logic                      closed_o,
  input logic                      found_o,
  input logic                      point_valid_o
);

  logic in_burst_q;
  logic [DirectionWidth-1:0] direction_q;
  logic [15:0] open_q, pointless_q;  // number of bursts not closed; number of nearest hits without their point

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      in_burst_q  <= 1'b0;
      open_q      <= '0;
      pointless_q <= '0;
    end else begin
      if (in_fire) in_burst_q <= !last_i;
      open_q <= open_q + 16'(in_fire && last_i) - 16'(out_fire && closed_o);
      pointless_q <= pointless_q + 16'(out_fire && closed_o && found_o)
                   - 16'(out_fire && point_valid_o);
    end
  end
  always_ff @(posedge clk_i) if (in_fire && first_i) direction_q <= direction_i;

  always_ff @(posedge clk_i) begin
    if (rst_ni && in_fire) begin
      a_first : assert (first_i != in_burst_q);
      a_one_direction : assert (first_i || direction_i == direction_q);
    end
    if (rst_ni && out_fire) begin
      a_closed : assert (!closed_o || open_q != '0);
      a_point : assert (!point_valid_o || pointless_q != '0);
      a_says_something : assert (report != 2'd0 || closed_o || point_valid_o);
      a_report : assert (report != 2'd3);
    end
  end

endmodule
