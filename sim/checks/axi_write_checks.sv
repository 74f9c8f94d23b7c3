// The rules of AXI4 for a manager's writes: each channel's VALID and payload hold until READY. VALID is low in reset.
// Bursts have type INCR, are no wider than the port and stay within 4 KiB. WLAST comes exactly with the last beat by
// AWLEN. A response comes after the burst's address and last beat. All bursts must have the same length and ID.
//
// Inputs: also check the subordinate.
// Source: AMBA AXI protocol specification, issue E, A3.2 to A3.4.
module axi_write_checks #(
  parameter int unsigned DataWidth = 128,
  parameter bit Inputs = 1'b1
) (
  input logic                             clk_i,
  input logic                             rst_ni,
  input logic                             awvalid,
  input logic                             awready,
  input logic [63:0]                      awaddr,
  input logic [7:0]                       awlen,
  input logic [2:0]                       awsize,
  input logic [1:0]                       awburst,
  input logic                             wvalid,
  input logic                             wready,
  input logic [DataWidth+DataWidth/8-1:0] w,  // WSTRB, WDATA
  input logic                             wlast,
  input logic                             bvalid,
  input logic                             bready,
  input logic [1:0]                       bresp,
  output logic [31:0]                     addresses_q,  // number of taken addresses without response; for proofs
  output logic [31:0]                     bursts_q,     // number of complete bursts without response; for proofs
  output logic [7:0]                      beat_q        // number of the next beat in its burst; for proofs
);

  stream_checks #(
    .Width(77)
  ) u_aw (
    .clk_i,
    .rst_ni,
    .valid(awvalid),
    .ready(awready),
    .data ({awaddr, awlen, awsize, awburst})
  );
  stream_checks #(
    .Width(DataWidth + DataWidth / 8 + 1)
  ) u_w (
    .clk_i,
    .rst_ni,
    .valid(wvalid),
    .ready(wready),
    .data ({w, wlast})
  );
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) {addresses_q, bursts_q, beat_q} <= '0;
    else begin
      addresses_q <= addresses_q + 32'(awvalid && awready) - 32'(bvalid && bready);
      bursts_q    <= bursts_q + 32'(wvalid && wready && wlast) - 32'(bvalid && bready);
      if (wvalid && wready) beat_q <= wlast ? '0 : beat_q + 8'd1;
    end
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni && awvalid) begin
      a_increments : assert (awburst == 2'b01);
      a_fits_the_port : assert ((13'd8 << awsize) <= 13'(DataWidth));
      a_within_4_kib : assert ({1'b0, awaddr[11:0]} + ((13'(awlen) + 13'd1) << awsize) <= 13'd4096);
    end
    if (rst_ni && wvalid) a_last_by_length : assert (wlast == (beat_q == awlen));
  end

  if (Inputs) begin : gen_inputs
    stream_checks #(
      .Width(2)
    ) u_b (
      .clk_i,
      .rst_ni,
      .valid(bvalid & rst_ni),
      .ready(bready),
      .data (bresp)
    );
    always_ff @(posedge clk_i) begin
      if (rst_ni && bvalid) a_was_asked : assert (addresses_q != 0 && bursts_q != 0);
    end
  end

  logic unused;
  assign unused = ^bresp;

endmodule
