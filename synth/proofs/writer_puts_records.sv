// Claims, from reset on, for any memory: The port that writes results obeys AXI4 (sim/checks/axi_write_checks). Result
// n since the last rewind (from 0) is written once, at base + 32 n, in order, while n < length. written_o counts the
// acknowledged results. Assumption: memory acknowledges only bursts that it has taken. opened_axi_write_manager is
// axi_write_manager with its registers as outputs.
module writer_puts_records #(
  parameter int unsigned DataWidth = 128,
  localparam int unsigned BeatWidth = (DataWidth < 256) ? DataWidth : 256,
  localparam int unsigned Beats = 256 / BeatWidth
) (
  input logic clk,
  input logic choose  // watch the result taken now
);

  (* anyseq *) logic [63:0] base;
  (* anyseq *) logic [31:0] length;
  (* anyseq *) logic [255:0] record;
  (* anyseq *) logic rewind, record_valid, awready, wready, bvalid;
  (* anyseq *) logic [1:0] bresp;

  logic reset_n;  // low for the first clock
  initial reset_n = 1'b0;
  always_ff @(posedge clk) reset_n <= 1'b1;

  logic busy, full, bus_error, record_ready, awvalid, wvalid, wlast, bready;
  logic [31:0] written, next, addresses, bursts;
  logic [63:0] awaddr;
  logic [7:0] awlen, beat;
  logic [2:0] awsize, left;
  logic [255:0] left_record;
  logic [1:0] awburst;
  logic [DataWidth-1:0] wdata;
  logic [DataWidth/8-1:0] wstrb;

  opened_axi_write_manager dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .base_i(base),
    .length_i(length),
    .rewind_i(rewind),
    .busy_o(busy),
    .full_o(full),
    .bus_error_o(bus_error),
    .written_o(written),
    .record_valid_i(record_valid),
    .record_ready_o(record_ready),
    .record_i(record),
    .axi_awvalid_o(awvalid),
    .axi_awready_i(awready),
    .axi_awaddr_o(awaddr),
    .axi_awlen_o(awlen),
    .axi_awsize_o(awsize),
    .axi_awburst_o(awburst),
    .axi_wvalid_o(wvalid),
    .axi_wready_i(wready),
    .axi_wdata_o(wdata),
    .axi_wstrb_o(wstrb),
    .axi_wlast_o(wlast),
    .axi_bvalid_i(bvalid),
    .axi_bready_o(bready),
    .axi_bresp_i(bresp),
    .next_q(next),
    .left_q(left),
    .record_q(left_record)
  );

  axi_write_checks #(
    .DataWidth(DataWidth),
    .Inputs(1'b0)
  ) u_checks (
    .clk_i(clk),
    .rst_ni(reset_n),
    .awvalid(awvalid),
    .awready(awready),
    .awaddr(awaddr),
    .awlen(awlen),
    .awsize(awsize),
    .awburst(awburst),
    .wvalid(wvalid),
    .wready(wready),
    .w({wstrb, wdata}),
    .wlast(wlast),
    .bvalid(bvalid),
    .bready(bready),
    .bresp(bresp),
    .addresses_q(addresses),
    .bursts_q(bursts),
    .beat_q(beat)
  );

  always_comb begin
    if (reset_n) begin
      assume (!bvalid || (addresses != '0 && bursts != '0));
      assume (!rewind || (!busy && !bvalid));
    end else assume (!bvalid && !rewind && !record_valid);
  end

  // ---- Numbers of results taken and acknowledged since the last rewind

  logic take;
  logic [31:0] taken, answered;
  assign take = record_valid && record_ready;
  always_ff @(posedge clk) begin
    if (!reset_n || rewind) {taken, answered} <= '0;
    else {taken, answered} <= {taken + 32'(take), answered + 32'(bvalid)};
  end

  // ---- The watched result: its address and its beats, until both have been taken

  logic watching, address_taken, in_upper;
  logic [3:0] beats;  // number of beats taken
  logic [63:0] its_address;
  logic [255:0] its_record;
  logic [DataWidth-1:0] its_data;
  logic [DataWidth/8-1:0] its_strobes;
  logic address_ends, data_ends;
  initial watching = 1'b0;
  assign address_ends = address_taken || awready;
  assign data_ends    = beats + 4'(wready && beats != 4'(Beats)) == 4'(Beats);
  always_ff @(posedge clk) begin
    if (!reset_n) watching <= 1'b0;
    else if (!watching || (address_ends && data_ends)) begin
      watching      <= take && choose;
      address_taken <= 1'b0;
      beats         <= '0;
      its_address   <= {base[63:6], 6'd0} + {27'd0, taken, 5'd0};
      its_record    <= record;
      in_upper      <= taken[0];
    end else begin
      address_taken <= address_ends;
      if (wready && beats != 4'(Beats)) beats <= beats + 4'd1;
    end
  end

  if (DataWidth > 256) begin : gen_half
    assign its_data    = {2{its_record}};
    assign its_strobes = {{32{in_upper}}, {32{!in_upper}}};
  end else begin : gen_whole
    assign its_data    = DataWidth'(its_record >> (BeatWidth * beats));
    assign its_strobes = '1;
  end

  always_comb begin
    if (reset_n) begin
      assert (written == answered && busy == (taken != answered));
      if (take) assert (taken < length && !rewind);
      assert (full == (record_valid && taken >= length && taken == answered));
      assert (bus_error == (bvalid && bresp[1]));
      if (watching) begin
        assert (awvalid == !address_taken && wvalid == (beats != 4'(Beats)));
        if (awvalid) assert (awaddr == its_address);
        if (wvalid) assert (wdata == its_data && wstrb == its_strobes);
        if (take) assert (address_ends && data_ends);
      end

      // Invariants
      assert (next == taken && taken - answered == addresses + 32'(awvalid));
      assert (taken - answered == bursts + 32'(wvalid));
      if (wvalid) assert (left <= 3'(Beats - 1) && beat == 8'(Beats - 1) - 8'(left));
      else assert (beat == '0);
      if (watching) begin
        assert (beats <= 4'(Beats) && !(address_taken && beats == 4'(Beats)));
        if (wvalid) assert (beats == 4'(Beats - 1) - 4'(left) && left_record == its_record >> (BeatWidth * beats));
      end

      cover (watching && address_taken && taken > 32'd2);
      cover (watching && beats == 4'(Beats) && addresses != '0);
      cover (full && taken > 32'd1);
    end
  end

endmodule
