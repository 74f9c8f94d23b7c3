// Several pipelined hit-test units side by side, and their counters.
//
// Every port has a slot for each lane, lane 0 lowest; for a slot's contents see hit_test_pipeline. Each lane has its
// own valid and ready, so no lane waits for another. All tests of a burst must go to one lane, where results keep
// order.
//
// counter_o is the counter of count_e that count_select_i selects (0 for other values), summed over the lanes since
// reset, modulo 2**CounterWidth, up to three clocks late. With 4 lanes, a counter of clocks counts up to 4 per clock.
module hit_test_array
  import hit_test_pkg::*;
#(
  parameter int unsigned Lanes     = 1,
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = arith_pkg::Graded,
  parameter bit [2:0]    RoundingMode = 3'd0,
  parameter int unsigned TagWidth  = 32,
  parameter int unsigned CounterWidth = 48,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth,
  localparam int unsigned RecordWidth = RecordWords * Width
) (
  input  logic                         clk_i,
  input  logic                         rst_ni,
  input  logic [Lanes-1:0]             valid_i,
  output logic [Lanes-1:0]             ready_o,
  input  logic [Lanes-1:0]             first_i,
  input  logic [Lanes-1:0]             last_i,
  input  logic [Lanes*TagWidth-1:0]    tag_i,
  input  logic [Lanes*3*Width-1:0]     direction_i,
  input  logic [Lanes*RecordWidth-1:0] record_i,
  output logic [Lanes-1:0]             valid_o,
  input  logic [Lanes-1:0]             ready_i,
  output logic [Lanes*2-1:0]           report_o,
  output logic [Lanes*TagWidth-1:0]    report_tag_o,
  output logic [Lanes-1:0]             closed_o,
  output logic [Lanes-1:0]             found_o,
  output logic [Lanes*TagWidth-1:0]    tag_o,
  output logic [Lanes*Width-1:0]       t_o,
  output logic [Lanes*TErrorWidth-1:0] t_error_o,
  output logic [Lanes-1:0]             point_valid_o,
  output logic [Lanes*3*Width-1:0]     point_o,
  input  logic [3:0]                   count_select_i,
  output logic [CounterWidth-1:0]      counter_o
);

  // ---- Lanes

  logic [Lanes*NumCounts-1:0] events;

  for (genvar n = 0; n < Lanes; n++) begin : gen_lane
    report_e report;

    hit_test_pipeline #(
      .ExpWidth(ExpWidth),
      .FracWidth(FracWidth),
      .Arith(Arith),
      .RoundingMode(RoundingMode),
      .TagWidth(TagWidth)
    ) u_pipeline (
      .clk_i,
      .rst_ni,
      .valid_i(valid_i[n]),
      .ready_o(ready_o[n]),
      .first_i(first_i[n]),
      .last_i(last_i[n]),
      .tag_i(tag_i[TagWidth*n +: TagWidth]),
      .direction_i(direction_i[3*Width*n +: 3*Width]),
      .record_i(record_i[RecordWidth*n +: RecordWidth]),
      .valid_o(valid_o[n]),
      .ready_i(ready_i[n]),
      .report_o(report),
      .report_tag_o(report_tag_o[TagWidth*n +: TagWidth]),
      .closed_o(closed_o[n]),
      .found_o(found_o[n]),
      .tag_o(tag_o[TagWidth*n +: TagWidth]),
      .t_o(t_o[Width*n +: Width]),
      .t_error_o(t_error_o[TErrorWidth*n +: TErrorWidth]),
      .point_valid_o(point_valid_o[n]),
      .point_o(point_o[3*Width*n +: 3*Width]),
      .events_o(events[NumCounts*n +: NumCounts])
    );
    assign report_o[2*n+:2] = report;
  end

  // ---- Counters

  logic [Lanes*NumCounts-1:0] events_q;
  logic [CounterWidth*NumCounts-1:0] counters;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) events_q <= '0;
    else events_q <= events;
  end

  for (genvar c = 0; c < NumCounts; c++) begin : gen_counter
    logic [CounterWidth-1:0] count_q, increment;

    always_comb begin
      increment = '0;
      for (int unsigned n = 0; n < Lanes; n++) begin
        increment = increment + CounterWidth'(events_q[NumCounts*n+c]);
      end
    end

    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) count_q <= '0;
      else count_q <= count_q + increment;
    end
    assign counters[CounterWidth*c+:CounterWidth] = count_q;
  end

  always_comb begin
    counter_o = '0;
    for (int unsigned c = 0; c < NumCounts; c++) begin
      if (count_select_i == 4'(c)) counter_o = counters[CounterWidth*c+:CounterWidth];
    end
  end

endmodule
