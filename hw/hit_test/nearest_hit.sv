// Keeps the nearest sure hit of each burst. Latency: 1 clock. Throughput: one test a clock.
//
// Distances are compared as integers, which orders positive floats. Two distances that differ by no more than the sum
// of their errors (2**(TErrorUnit + t_error) units in the last place each) are a near tie: either hit may be nearer.
// The hit with the smaller t is kept (of equal ones the first), the other hit is reported. So a hit that is dropped
// without a report is certainly farther than the hit kept at that time. The kept hit in turn is the burst's result, or
// is reported, or is certainly farther than a later hit.
//
// A sure hit whose t is no positive normal number is reported as a doubt.
//
// All outputs except sure_hit_o are registers:
//   closed_o  high for one clock after the last test of a burst. found_o then says whether the burst has a nearest hit,
//             and tag_o, t_o, t_error_o and payload_o are that hit's. closed_o and found_o are reset.
//   report_o  after any test. report_tag_o is the reported hit's tag or, without a report, the tag of the last test.
// payload_i is user data that is kept with the nearest hit.
module nearest_hit
  import hit_test_pkg::*;
#(
  parameter int unsigned ExpWidth     = 8,
  parameter int unsigned FracWidth    = 23,
  parameter int unsigned TagWidth     = 32,
  parameter int unsigned PayloadWidth = 160,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    valid_i,  // a test; else the inputs below are ignored
  input  logic                    first_i,  // the first test of its burst
  input  logic                    last_i,  // the last test of its burst
  input  logic                    hit_i,
  input  logic                    doubt_i,
  input  logic [TagWidth-1:0]     tag_i,
  input  logic [Width-1:0]        t_i,
  input  logic [TErrorWidth-1:0]  t_error_i,
  input  logic [PayloadWidth-1:0] payload_i,
  output logic                    sure_hit_o,  // combinational: a sure hit with a valid t
  output report_e                 report_o,
  output logic [TagWidth-1:0]     report_tag_o,
  output logic                    closed_o,
  output logic                    found_o,
  output logic [TagWidth-1:0]     tag_o,
  output logic [Width-1:0]        t_o,
  output logic [TErrorWidth-1:0]  t_error_o,
  output logic [PayloadWidth-1:0] payload_o
);

  // ---- Is t a positive normal number?

  logic [ExpWidth-1:0] exponent;
  logic hit, doubt;

  assign exponent = t_i[FracWidth +: ExpWidth];
  assign hit   = valid_i & hit_i & ~t_i[Width-1] & (exponent != '0) & ~(&exponent);
  assign doubt = valid_i & (doubt_i | (hit_i & ~hit));
  assign sure_hit_o = hit;

  // ---- Nearer or farther than the nearest so far, and by more than the errors?

  // Margins stay below 2**(FracWidth+3) and distances below 2**(Width-1): Width + 1 bits suffice.
  logic [Width:0] t, best, margin, farther, nearer;
  logic have, near, smaller, replace;

  assign t       = {1'b0, t_i};
  assign best    = {1'b0, t_o};
  assign margin  = ((Width + 1)'(1) << (TErrorUnit + 32'(t_error_i)))
                 + ((Width + 1)'(1) << (TErrorUnit + 32'(t_error_o)));
  assign farther = margin + best - t;  // negative: surely farther
  assign nearer  = margin + t - best;  // negative: surely nearer
  assign smaller = t_i < t_o;

  assign have    = found_o & ~first_i;
  assign near    = hit & have & ~farther[Width] & ~nearer[Width];
  assign replace = hit & (~have | smaller);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      closed_o <= 1'b0;
      found_o  <= 1'b0;
      report_o <= ReportNone;
    end else begin
      closed_o <= valid_i & last_i;
      if (valid_i) found_o <= have | hit;
      report_o <= doubt ? ReportDoubt : near ? ReportNearTie : ReportNone;
    end
  end

  always_ff @(posedge clk_i) begin
    report_tag_o <= (near & smaller) ? tag_o : tag_i;
    if (replace) begin
      tag_o     <= tag_i;
      t_o       <= t_i;
      t_error_o <= t_error_i;
      payload_o <= payload_i;
    end
  end

endmodule
