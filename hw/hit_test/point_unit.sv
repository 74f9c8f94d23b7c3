// The points of nearest hits, P_k = (d I_k) / V (equation 10): one multiplier, and the free clocks of
// a divider that is somebody else's.
//
// push_i hands in I, V and d; there must be room (2**LogPoints of them wait here, pop_o says when one
// has left). Its three coordinates are multiplied one after the other and offered to the divider,
// valid_o until taken_i; taken_i needs valid_o. Quotients come back in that order whenever they do.
// After the third one point_valid_o is true for one clock, with point_o = Pz, Py, Px from the top.
// Clocks without enable_i don't count.
module point_unit #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Adder     = arith_pkg::AdderGraded,
  parameter bit [2:0]    RoundingMode = 3'd0,
  parameter int unsigned LogPoints = 3,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic               clk_i,
  input  logic               rst_ni,
  input  logic               enable_i,
  input  logic               push_i,
  input  logic [3*Width-1:0] direction_i,
  input  logic [Width-1:0]   v_i,
  input  logic [Width-1:0]   d_i,
  output logic               pop_o,
  output logic               valid_o,
  input  logic               taken_i,
  output logic [Width-1:0]   dividend_o,
  output logic [Width-1:0]   divisor_o,
  input  logic               quotient_valid_i,
  input  logic [Width-1:0]   quotient_i,
  output logic               point_valid_o,
  output logic [3*Width-1:0] point_o
);

  localparam int unsigned Latency = hit_test_pkg::MultiplierLatency;

  // ---- Those that wait, and the coordinate that is next

  logic move, waiting, unused_space;
  logic [3*Width-1:0] direction;
  logic [Width-1:0] v, d, component;
  logic [1:0] axis_q;

  assign move  = enable_i & (~valid_o | taken_i);  // the multiplier's stages
  assign pop_o = move & waiting & axis_q[1];

  fifo #(
    .Width(5 * Width),
    .LogDepth(LogPoints)
  ) u_waiting (
    .clk_i,
    .rst_ni,
    .push_i(push_i),
    .data_i({direction_i, v_i, d_i}),
    .space_o(unused_space),
    .pop_i(pop_o),
    .valid_o(waiting),
    .data_o({direction, v, d})
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) axis_q <= 2'd0;
    else if (move && waiting) axis_q <= axis_q[1] ? 2'd0 : axis_q + 2'd1;
  end

  always_comb begin
    unique case (axis_q)
      2'd0:    component = direction[0 +: Width];
      2'd1:    component = direction[Width +: Width];
      default: component = direction[2*Width +: Width];
    endcase
  end

  // ---- Multiply

  logic [Latency-1:0] multiplying_q;
  fp_pkg::flags_t unused_flags;

  fp_multiplier_stages #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .Adder(Adder),
    .Cuts(hit_test_pkg::MultiplierCuts)
  ) u_multiplier (
    .clk_i,
    .enable_i(move),
    .a_i(d),
    .b_i(component),
    .rounding_mode_i(RoundingMode),
    .tininess_after_i(1'b0),
    .result_o(dividend_o),
    .flags_o(unused_flags)
  );
  delay_line #(
    .Width(Width),
    .Depth(Latency)
  ) u_divisor (
    .clk_i,
    .enable_i(move),
    .data_i(v),
    .data_o(divisor_o)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) multiplying_q <= '0;
    else if (move) multiplying_q <= {multiplying_q[Latency-2:0], waiting};
  end
  assign valid_o = multiplying_q[Latency-1];

  // ---- Collect the quotients

  logic [1:0] collected_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      collected_q   <= 2'd0;
      point_valid_o <= 1'b0;
    end else if (enable_i) begin
      if (quotient_valid_i) collected_q <= collected_q[1] ? 2'd0 : collected_q + 2'd1;
      point_valid_o <= quotient_valid_i & collected_q[1];
    end
  end

  always_ff @(posedge clk_i) begin
    if (enable_i && quotient_valid_i) point_o <= {quotient_i, point_o[3*Width-1:Width]};
  end

endmodule
