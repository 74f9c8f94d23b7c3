// The rules of AXI4 for a manager's reads: each channel's VALID and payload hold until READY. VALID is low in reset.
// Bursts have type INCR, are no wider than the port and stay within 4 KiB. A beat comes only for a requested burst, and
// RLAST exactly with the last beat by ARLEN. In addition to AXI4's rules, an ID has at most one burst in flight.
//
// Inputs: also check the subordinate. Last: also check RLAST.
// Source: AMBA AXI protocol specification, issue E, A3.2 to A3.4, A5.
module axi_read_checks #(
  parameter int unsigned IdWidth   = 6,
  parameter int unsigned DataWidth = 128,
  parameter bit Inputs = 1'b1,
  parameter bit Last   = 1'b1
) (
  input logic                 clk_i,
  input logic                 rst_ni,
  input logic                 arvalid,
  input logic                 arready,
  input logic [IdWidth-1:0]   arid,
  input logic [63:0]          araddr,
  input logic [7:0]           arlen,
  input logic [2:0]           arsize,
  input logic [1:0]           arburst,
  input logic                 rvalid,
  input logic                 rready,
  input logic [IdWidth-1:0]   rid,
  input logic [DataWidth+1:0] r,  // RRESP, RDATA
  input logic                 rlast,
  output logic [2**IdWidth-1:0]   open_q,  // for each ID: a burst is in flight; for proofs
  output logic [8*2**IdWidth-1:0] left_q   // for each ID: number of beats after the next beat; for proofs
);

  stream_checks #(
    .Width(IdWidth + 77)
  ) u_ar (
    .clk_i,
    .rst_ni,
    .valid(arvalid),
    .ready(arready),
    .data ({arid, araddr, arlen, arsize, arburst})
  );

  logic [12:0] bytes;
  assign bytes = (13'(arlen) + 13'd1) << arsize;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) open_q <= '0;
    else begin
      if (rvalid && rready && left_q[8*rid+:8] == 0) open_q[rid] <= 1'b0;
      if (arvalid && arready) open_q[arid] <= 1'b1;
    end
  end
  always_ff @(posedge clk_i) begin
    if (rvalid && rready) left_q[8*rid+:8] <= left_q[8*rid+:8] - 8'd1;
    if (arvalid && arready) left_q[8*arid+:8] <= arlen;
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni && arvalid) begin
      a_increments : assert (arburst == 2'b01);
      a_fits_the_port : assert ((13'd8 << arsize) <= 13'(DataWidth));
      a_within_4_kib : assert ({1'b0, araddr[11:0]} + bytes <= 13'd4096);
      a_one_burst_an_id : assert (!open_q[arid]);
    end
  end

  if (Inputs) begin : gen_inputs
    stream_checks #(
      .Width(IdWidth + DataWidth + 3)
    ) u_r (
      .clk_i,
      .rst_ni,
      .valid(rvalid & rst_ni),
      .ready(rready),
      .data ({rid, r, rlast})
    );
    always_ff @(posedge clk_i) begin
      if (rst_ni && rvalid) begin
        a_was_asked : assert (open_q[rid]);
        if (Last) a_last_by_length : assert (rlast == (left_q[8*rid+:8] == 0));
      end
    end
  end

  logic unused;
  assign unused = ^{r, rlast};

endmodule
