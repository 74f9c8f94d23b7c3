// The rules of AXI4-Lite at a subordinate's port: each channel's VALID and payload hold until READY. VALID is low in
// reset. A write gets one response, after address and data were taken. A read gets one response, after its address.
//
// Inputs: also check the manager. Proofs set Inputs to 0, because they assume nothing about the manager.
// Source: AMBA AXI protocol specification, issue E, A3.2, A3.3, B1.
module axi_lite_checks #(
  parameter int unsigned AddressWidth = 12,
  parameter bit Inputs = 1'b1
) (
  input logic                    clk_i,
  input logic                    rst_ni,
  input logic                    awvalid,
  input logic                    awready,
  input logic [AddressWidth-1:0] awaddr,
  input logic                    wvalid,
  input logic                    wready,
  input logic [35:0]             w,
  input logic                    bvalid,
  input logic                    bready,
  input logic [1:0]              bresp,
  input logic                    arvalid,
  input logic                    arready,
  input logic [AddressWidth-1:0] araddr,
  input logic                    rvalid,
  input logic                    rready,
  input logic [33:0]             r,
  output logic [3:0]             addresses_q,  // numbers of taken addresses, words, reads without response; for proofs
  output logic [3:0]             words_q,
  output logic [3:0]             reads_q
);

  if (Inputs) begin : gen_inputs
    stream_checks #(
      .Width(AddressWidth)
    ) u_aw (
      .clk_i,
      .rst_ni,
      .valid(awvalid & rst_ni),
      .ready(awready),
      .data (awaddr)
    );
    stream_checks #(
      .Width(36)
    ) u_w (
      .clk_i,
      .rst_ni,
      .valid(wvalid & rst_ni),
      .ready(wready),
      .data (w)
    );
    stream_checks #(
      .Width(AddressWidth)
    ) u_ar (
      .clk_i,
      .rst_ni,
      .valid(arvalid & rst_ni),
      .ready(arready),
      .data (araddr)
    );
  end
  stream_checks #(
    .Width(2)
  ) u_b (
    .clk_i,
    .rst_ni,
    .valid(bvalid),
    .ready(bready),
    .data (bresp)
  );
  stream_checks #(
    .Width(34)
  ) u_r (
    .clk_i,
    .rst_ni,
    .valid(rvalid),
    .ready(rready),
    .data (r)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) {addresses_q, words_q, reads_q} <= '0;
    else begin
      addresses_q <= addresses_q + 4'(awvalid && awready) - 4'(bvalid && bready);
      words_q     <= words_q + 4'(wvalid && wready) - 4'(bvalid && bready);
      reads_q     <= reads_q + 4'(arvalid && arready) - 4'(rvalid && rready);
    end
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      a_write_was_asked : assert (!bvalid || (addresses_q != 0 && words_q != 0));
      a_read_was_asked : assert (!rvalid || reads_q != 0);
      a_few : assert (addresses_q < 15 && words_q < 15 && reads_q < 15);
    end
  end

endmodule
