// Point where a ray meets a plane: P_k = (d I_k) / V (equation 10), three coordinates at once, from the products d I_k.
// Latency: divide_latency (see hit_test_pkg), throughput one point a clock. valid_o is valid_i, as much later; reset.
//
// Three dividers: no fewer do for streams in which nearly every other test is a nearest hit, which is
// what is left when a tree of boxes has ruled out most polygons.
module point_unit
  import hit_test_pkg::*;
#(
  parameter int unsigned ExpWidth = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith = arith_pkg::Graded,
  parameter bit [2:0] RoundingMode = 3'd0,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic               clk_i,
  input  logic               rst_ni,
  input  logic               valid_i,
  input  logic [3*Width-1:0] dividends_i,
  input  logic [Width-1:0]   v_i,
  output logic               valid_o,
  output logic [3*Width-1:0] point_o
);

  localparam int unsigned Latency = divide_latency(FracWidth);

  logic [Latency-1:0] valid_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= '0;
    else valid_q <= {valid_q[Latency-2:0], valid_i};
  end
  assign valid_o = valid_q[Latency-1];

  for (genvar k = 0; k < 3; k++) begin : gen_coordinate

    fp_divider #(
      .ExpWidth(ExpWidth),
      .FracWidth(FracWidth),
      .Arith(Arith),
      .Pipelined(1'b1)
    ) u_divider (
      .clk_i,
      .valid_i,
      .a_i(dividends_i[Width*k+:Width]),
      .b_i(v_i),
      .rounding_mode_i(RoundingMode),
      .tininess_after_i(1'b0),
      .result_o(point_o[Width*k+:Width]),
      .flags_o()
    );
  end

endmodule
