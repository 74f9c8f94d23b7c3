// Pipelined hit-test unit: verdict of each test, nearest hit of each burst. It takes a ray direction and a polygon
// record in each clock; a burst's nearest hit comes with its t and P.
//
//   scale    I_k times N_k, the E_k and d     15 multipliers, see hit_dots; their first registers take the test
//   add      V = N . I, U_k = E_k . I         8 adders
//   decide   hit, miss or doubt               see hit_decision
//   divide   t = d / V                        a divider
//   nearest  the nearest hit of the burst     see nearest_hit
//   point    P_k = (d I_k) / V, equation 10   3 dividers, because each test may be a burst of its own
//
// Throughput: one test a clock. Latency: DotLatency + divide_latency + 3 clocks (see hit_test_pkg): from the clock edge
// that takes a test to the edge after which its report, or the result of its burst, is at the output. All tests of a
// burst must have the same I.
//
// Input: valid/ready; first_i and last_i mark the first and last test of a burst; tag_i is returned with results.
// Output: valid/ready; one word carries up to three things:
//   report_o         not ReportNone: the test report_tag_o is in doubt or in a near tie
//   closed_o         a burst is over; bursts end in the order in which they came. If found_o is high, its nearest hit
//                    is test tag_o, at t_o (error: see hit_test_pkg), and its P follows. If neither found_o is high nor
//                    a test is reported, report_tag_o is the tag of the burst's last test.
//   point_valid_o    point_o is the P of a burst that was closed with found_o earlier; bursts keep their order
//
// ready_o and valid_o are registers. The pipeline never stalls: a test is taken only while the queue of results has a
// free word for every clock of the latency. So ready_o falls only if results are not taken.
//
// All words are IEEE numbers of the format ExpWidth, FracWidth; dot products are (x + y) + z, rounded after each
// operation. RoundingMode applies to all operations. With RoundNearestEven, hit and miss verdicts are never wrong.
module hit_test_pipeline
  import hit_test_pkg::*;
#(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = arith_pkg::Graded,
  parameter bit [2:0]    RoundingMode = 3'd0,
  parameter int unsigned TagWidth  = 32,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic                         clk_i,
  input  logic                         rst_ni,
  input  logic                         valid_i,
  output logic                         ready_o,
  input  logic                         first_i,
  input  logic                         last_i,
  input  logic [TagWidth-1:0]          tag_i,
  input  logic [3*Width-1:0]           direction_i,
  input  logic [RecordWords*Width-1:0] record_i,
  output logic                         valid_o,
  input  logic                         ready_i,
  output report_e                      report_o,
  output logic [TagWidth-1:0]          report_tag_o,
  output logic                         closed_o,
  output logic                         found_o,
  output logic [TagWidth-1:0]          tag_o,
  output logic [Width-1:0]             t_o,
  output logic [TErrorWidth-1:0]       t_error_o,
  output logic                         point_valid_o,
  output logic [3*Width-1:0]           point_o,
  output logic [NumCounts-1:0]         events_o  // events of this clock, see count_e
);

  localparam int unsigned DivideLatency = divide_latency(FracWidth);

  // ---- Take

  logic [DotLatency-1:0] test_q;  // a test is in this stage of the dot products

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) test_q <= '0;
    else test_q <= {test_q[DotLatency-2:0], valid_i & ready_o};
  end

  // ---- Scale and add: V and U_k

  logic [Width-1:0] v;
  logic [3*Width-1:0] u, dot_dividends;

  hit_dots #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .Arith(Arith),
    .RoundingMode(RoundingMode)
  ) u_dots (
    .clk_i,
    .step_i(1'b1),
    .normal_i(record_i[Width*RecordNormal +: 3*Width]),
    .edges_i(record_i[Width*RecordEdges +: 9*Width]),
    .d_i(record_i[Width*RecordD +: Width]),
    .direction_i,
    .v_o(v),
    .u_o(u),
    .dividends_o(dot_dividends)
  );

  // The rest of the record bypasses the dot products. Of N, only the largest exponent is needed.
  logic [ExpWidth-1:0] nx_exponent, ny_exponent, nz_exponent, nxy_exponent, normal_exponent;

  assign nx_exponent     = record_i[Width*RecordNormal+FracWidth +: ExpWidth];
  assign ny_exponent     = record_i[Width*(RecordNormal+1)+FracWidth +: ExpWidth];
  assign nz_exponent     = record_i[Width*(RecordNormal+2)+FracWidth +: ExpWidth];
  assign nxy_exponent    = (nx_exponent > ny_exponent) ? nx_exponent : ny_exponent;
  assign normal_exponent = (nz_exponent > nxy_exponent) ? nz_exponent : nxy_exponent;

  logic [3*Width-1:0] dot_bounds;
  logic [Width-1:0] dot_d;
  logic [TagWidth-1:0] dot_tag;
  logic [ExpWidth-1:0] dot_exponent;
  logic dot_first, dot_last;

  delay_line #(
    .Width(4 * Width + TagWidth + ExpWidth + 2),
    .Depth(DotLatency)
  ) u_sideband_dot (
    .clk_i,
    .enable_i(1'b1),
    .data_i({normal_exponent, first_i, last_i, tag_i,
             record_i[Width*RecordBounds +: 3*Width],
             record_i[Width*RecordD +: Width]}),
    .data_o({dot_exponent, dot_first, dot_last, dot_tag, dot_bounds, dot_d})
  );

  // ---- Decide

  logic miss, hit, doubt;
  logic [TErrorWidth-1:0] t_error;

  hit_decision #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth)
  ) u_decision (
    .d_i(dot_d),
    .normal_exponent_i(dot_exponent),
    .v_i(v),
    .u_i(u),
    .bounds_i(dot_bounds),
    .miss_o(miss),
    .hit_o(hit),
    .doubt_o(doubt),
    .t_error_o(t_error)
  );

  logic decided_q, miss_q, hit_q, doubt_q, decided_first_q, decided_last_q;
  logic [TErrorWidth-1:0] t_error_q;
  logic [TagWidth-1:0] decided_tag_q;
  logic [3*Width-1:0] decided_dividends_q;
  logic [Width-1:0] decided_d_q, decided_v_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) decided_q <= 1'b0;
    else decided_q <= test_q[DotLatency-1];
  end

  always_ff @(posedge clk_i) begin
    {miss_q, hit_q, doubt_q, t_error_q} <= {miss, hit, doubt, t_error};
    {decided_first_q, decided_last_q, decided_tag_q} <= {dot_first, dot_last, dot_tag};
    {decided_dividends_q, decided_d_q, decided_v_q} <= {dot_dividends, dot_d, v};
  end

  // ---- Divide: t of sure hits

  logic [Width-1:0] quotient;

  fp_divider #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .Arith(Arith),
    .Pipelined(1'b1)
  ) u_divider (
    .clk_i,
    .valid_i(decided_q & hit_q),
    .a_i(decided_d_q),
    .b_i(decided_v_q),
    .rounding_mode_i(RoundingMode),
    .tininess_after_i(1'b0),
    .result_o(quotient),
    .flags_o()
  );

  localparam int unsigned PayloadWidth = 4 * Width;
  localparam int unsigned DividedWidth = PayloadWidth + TagWidth + TErrorWidth + 4;
  logic [PayloadWidth-1:0] divided_payload;
  logic [TagWidth-1:0] divided_tag;
  logic [TErrorWidth-1:0] divided_t_error;
  logic divided_first, divided_last, divided_hit, divided_doubt;
  logic [DivideLatency-1:0] dividing_q;

  delay_line #(
    .Width(DividedWidth),
    .Depth(DivideLatency)
  ) u_sideband_divider (
    .clk_i,
    .enable_i(1'b1),
    .data_i({t_error_q, decided_first_q, decided_last_q, hit_q, doubt_q, decided_tag_q,
             decided_dividends_q, decided_v_q}),
    .data_o({divided_t_error, divided_first, divided_last, divided_hit, divided_doubt, divided_tag,
             divided_payload})
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) dividing_q <= '0;
    else dividing_q <= {dividing_q[DivideLatency-2:0], decided_q};
  end

  // ---- Nearest

  report_e report;
  logic [TagWidth-1:0] report_tag, nearest_tag;
  logic closed, found, sure_hit;
  logic [Width-1:0] t;
  logic [TErrorWidth-1:0] nearest_t_error;
  logic [PayloadWidth-1:0] nearest_payload;

  nearest_hit #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .TagWidth(TagWidth),
    .PayloadWidth(PayloadWidth)
  ) u_nearest (
    .clk_i,
    .rst_ni,
    .valid_i(dividing_q[DivideLatency-1]),
    .first_i(divided_first),
    .last_i(divided_last),
    .hit_i(divided_hit),
    .doubt_i(divided_doubt),
    .tag_i(divided_tag),
    .t_i(quotient),
    .t_error_i(divided_t_error),
    .payload_i(divided_payload),
    .sure_hit_o(sure_hit),
    .report_o(report),
    .report_tag_o(report_tag),
    .closed_o(closed),
    .found_o(found),
    .tag_o(nearest_tag),
    .t_o(t),
    .t_error_o(nearest_t_error),
    .payload_o(nearest_payload)
  );

  // ---- Point

  logic point_asked, point_valid;
  logic [DivideLatency-1:0] point_q;
  logic [3*Width-1:0] point;

  assign point_asked = closed & found;
  assign point_valid = point_q[DivideLatency-1];

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) point_q <= '0;
    else point_q <= {point_q[DivideLatency-2:0], point_asked};
  end

  for (genvar k = 0; k < 3; k++) begin : gen_coordinate
    fp_divider #(
      .ExpWidth(ExpWidth),
      .FracWidth(FracWidth),
      .Arith(Arith),
      .Pipelined(1'b1)
    ) u_point_divider (
      .clk_i,
      .valid_i(point_asked),
      .a_i(nearest_payload[Width*(1+k)+:Width]),
      .b_i(nearest_payload[0+:Width]),
      .rounding_mode_i(RoundingMode),
      .tininess_after_i(1'b0),
      .result_o(point[Width*k+:Width]),
      .flags_o()
    );
  end

  // ---- Results: while ready_o is high, the queue has room for all results in flight, at most one for each clock edge

  localparam int unsigned ResultWidth = 2 + 2 * TagWidth + 2 + Width + TErrorWidth + 1 + 3 * Width;
  logic push;
  logic [ResultWidth-1:0] pushed, word;

  assign push   = report != ReportNone | closed | point_valid;
  assign pushed = {report, closed, found, nearest_t_error, point_valid, report_tag, nearest_tag, t,
                   point};
  assign {report_o, closed_o, found_o, t_error_o, point_valid_o, report_tag_o, tag_o, t_o,
          point_o} = word;

  localparam int unsigned Reserve = point_latency(FracWidth) - 1;

  fifo #(
    .Width(ResultWidth),
    .Depth(Reserve + 3),
    .Reserve(Reserve)
  ) u_results (
    .clk_i,
    .rst_ni,
    .push_i(push),
    .data_i(pushed),
    .space_o(ready_o),
    .pop_i(valid_o & ready_i),
    .valid_o,
    .data_o(word)
  );

  // ---- Events

  logic stalled_q;  // ready_o was low in the clock before

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) stalled_q <= 1'b0;
    else stalled_q <= ~ready_o;
  end

  always_comb begin
    events_o = '0;
    events_o[CountTests]        = test_q[0];
    events_o[CountMisses]       = decided_q & miss_q;
    events_o[CountHits]         = sure_hit;
    events_o[CountDoubts]       = report == ReportDoubt;
    events_o[CountNearTies]     = report == ReportNearTie;
    events_o[CountDistances]    = decided_q & hit_q;
    events_o[CountPoints]       = point_valid;
    events_o[CountIdleClocks]   = ~test_q[0] & ~stalled_q;
    events_o[CountOutputStalls] = stalled_q;
  end

endmodule
