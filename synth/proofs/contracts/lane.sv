// Contract of a lane: the outputs are arbitrary. Wire `given` has all inputs, `said` and `counted` all outputs.
module hit_test_pipeline #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = 0,
  parameter bit [2:0]    RoundingMode = 3'd0,
  parameter int unsigned TagWidth  = 32,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth,
  localparam int unsigned RecordWidth = hit_test_pkg::RecordWords * Width,
  localparam int unsigned TErrorWidth = hit_test_pkg::TErrorWidth
) (
  input  logic                   clk_i,
  input  logic                   rst_ni,
  input  logic                   valid_i,
  output logic                   ready_o,
  input  logic                   first_i,
  input  logic                   last_i,
  input  logic [TagWidth-1:0]    tag_i,
  input  logic [3*Width-1:0]     direction_i,
  input  logic [RecordWidth-1:0] record_i,
  output logic                   valid_o,
  input  logic                   ready_i,
  output hit_test_pkg::report_e  report_o,
  output logic [TagWidth-1:0]    report_tag_o,
  output logic                   closed_o,
  output logic                   found_o,
  output logic [TagWidth-1:0]    tag_o,
  output logic [Width-1:0]       t_o,
  output logic [TErrorWidth-1:0] t_error_o,
  output logic                   point_valid_o,
  output logic [3*Width-1:0]     point_o,
  output logic [hit_test_pkg::NumCounts-1:0] events_o
);
  (* keep *) logic [5+TagWidth+3*Width+RecordWidth-1:0] given;
  (* anyseq, keep *) logic [7+2*TagWidth+4*Width+TErrorWidth-1:0] said;
  (* anyseq, keep *) logic [hit_test_pkg::NumCounts-1:0] counted;

  assign given = {rst_ni, valid_i, first_i, last_i, tag_i, direction_i, record_i, ready_i};
  assign {ready_o, valid_o, report_o, report_tag_o, closed_o, found_o, tag_o, t_o, t_error_o,
          point_valid_o, point_o} = said;
  assign events_o = counted;
endmodule
