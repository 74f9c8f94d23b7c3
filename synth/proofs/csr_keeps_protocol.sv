// Claims, from reset on, for any manager: The register port obeys AXI4-Lite (sim/checks/axi_lite_checks). A plain
// register (access `idle`) changes only in writable bits of enabled bytes, by a write to it with response OKAY. Writes
// to it get SLVERR while rays are generated or traced, and to `base` also while lines are read. A read returns its
// value. The watched plain register is arbitrary. opened_csr is csr with some registers as outputs.
module csr_keeps_protocol (
  input logic clk
);

  (* anyseq *) logic awvalid, wvalid, bready, arvalid, rready, generating, tracing, reading, writing;
  (* anyseq *) logic [11:0] awaddr, araddr;
  (* anyseq *) logic [31:0] wdata, written;
  (* anyseq *) logic [3:0] wstrb;
  (* anyseq *) logic [4:0] raised;
  (* anyseq *) logic [27:0] error_number;
  (* anyseq *) logic [ray_core_pkg::NumEvents-1:0] events;
  (* anyconst *) logic [4:0] number;  // number of the watched word

  logic reset_n;  // low for the first clock
  initial reset_n = 1'b0;
  always_ff @(posedge clk) reset_n <= 1'b1;

  logic awready, wready, bvalid, arready, rvalid, start, invalidate, abort, drawing, rewind, interrupt;
  logic [1:0] bresp, rresp;
  logic [31:0] rdata, corner, size, length;
  logic [63:0] base, results;
  logic [27:0] lines;
  logic [4*96-1:0] camera;
  logic [1023:0] words;
  logic address_q, data_q;
  logic [9:0] write_word_q;
  logic [3:0] strobes_q;
  logic [31:0] write_data_q;

  opened_csr dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .axi_awvalid_i(awvalid),
    .axi_awready_o(awready),
    .axi_awaddr_i(awaddr),
    .axi_wvalid_i(wvalid),
    .axi_wready_o(wready),
    .axi_wdata_i(wdata),
    .axi_wstrb_i(wstrb),
    .axi_bvalid_o(bvalid),
    .axi_bready_i(bready),
    .axi_bresp_o(bresp),
    .axi_arvalid_i(arvalid),
    .axi_arready_o(arready),
    .axi_araddr_i(araddr),
    .axi_rvalid_o(rvalid),
    .axi_rready_i(rready),
    .axi_rdata_o(rdata),
    .axi_rresp_o(rresp),
    .start_o(start),
    .invalidate_o(invalidate),
    .abort_o(abort),
    .drawing_o(drawing),
    .base_o(base),
    .lines_o(lines),
    .corner_o(corner),
    .size_o(size),
    .camera_o(camera),
    .camera_busy_i(generating),
    .core_busy_i(tracing),
    .outstanding_i(reading),
    .doubt_i(raised[0]),
    .ray_error_i(raised[1]),
    .bus_error_i(raised[2]),
    .full_i(raised[3]),
    .write_error_i(raised[4]),
    .writing_i(writing),
    .written_i(written),
    .results_o(results),
    .length_o(length),
    .rewind_o(rewind),
    .error_number_i(error_number),
    .events_i(events),
    .interrupt_o(interrupt),
    .words(words),
    .address_q(address_q),
    .data_q(data_q),
    .write_word_q(write_word_q),
    .strobes_q(strobes_q),
    .write_data_q(write_data_q)
  );

  logic [3:0] addresses, data_words, reads;

  axi_lite_checks #(
    .Inputs(1'b0)
  ) u_checks (
    .clk_i(clk),
    .rst_ni(reset_n),
    .awvalid(awvalid),
    .awready(awready),
    .awaddr(awaddr),
    .wvalid(wvalid),
    .wready(wready),
    .w({wdata, wstrb}),
    .bvalid(bvalid),
    .bready(bready),
    .bresp(bresp),
    .arvalid(arvalid),
    .arready(arready),
    .araddr(araddr),
    .rvalid(rvalid),
    .rready(rready),
    .r({rdata, rresp}),
    .addresses_q(addresses),
    .words_q(data_words),
    .reads_q(reads)
  );

  // ---- The watched word: its value, and its writable bits

  logic [1023:0] shown;
  logic [31:0] word, bits;
  always_comb begin
    shown = '0;
    shown[32*32'(csr_pkg::WordBase)+:64]   = base;
    shown[32*32'(csr_pkg::WordLines)+:32]  = {4'd0, lines};
    shown[32*32'(csr_pkg::WordCorner)+:32] = corner;
    shown[32*32'(csr_pkg::WordSize)+:32]   = size;
    shown[32*32'(csr_pkg::WordResults)+:64] = results;
    shown[32*32'(csr_pkg::WordLength)+:32] = length;
    shown[32*32'(csr_pkg::WordEye)+:96]    = camera[0+:96];
    shown[32*32'(csr_pkg::WordFirst)+:96]  = camera[96+:96];
    shown[32*32'(csr_pkg::WordRight)+:96]  = camera[192+:96];
    shown[32*32'(csr_pkg::WordDown)+:96]   = camera[288+:96];
  end
  assign word = words[32*number+:32];
  assign bits = csr_pkg::PlainBits[number];
  always_comb assume (bits != '0);

  // ---- The expected value: a write takes effect in the clock before its response

  logic [9:0] address;  // the last write address
  logic [31:0] data, mask, word_before, expected;
  logic [3:0] strobes;
  logic busy_before, reading_before, bvalid_before, answered, is_watched, is_base, read_watched;
  assign mask       = {{8{strobes[3]}}, {8{strobes[2]}}, {8{strobes[1]}}, {8{strobes[0]}}};
  assign answered   = bvalid && !bvalid_before;
  assign is_watched = address == 10'(number);
  assign is_base    = number == 5'(csr_pkg::WordBase) || number == 5'(csr_pkg::WordBaseHigh);

  initial word_before = '0;
  initial bvalid_before = 1'b0;
  initial read_watched = 1'b0;
  always_ff @(posedge clk) begin
    if (awvalid && awready) address <= awaddr[11:2];
    if (wvalid && wready) {data, strobes} <= {wdata, wstrb};
    word_before    <= reset_n ? word : '0;
    bvalid_before  <= reset_n && bvalid;
    busy_before    <= generating || tracing;
    reading_before <= reading;
    if (!reset_n) read_watched <= 1'b0;
    else if (arvalid && arready) begin
      read_watched <= araddr[11:2] == 10'(number);
      expected     <= word;
    end
  end

  always_comb begin
    if (!reset_n) assert (!bvalid && !rvalid && word == '0);
    else begin
      if (answered && is_watched && bresp == 2'b00) begin
        assert (word == ((data & mask & bits) | (word_before & ~mask)));
      end else assert (word == word_before);
      if (answered && is_watched) begin
        assert ((bresp == 2'b10) == (busy_before || (is_base && reading_before)));
      end
      if (bvalid) assert (!bresp[0]);
      if (rvalid) assert (rresp == 2'b00);
      if (rvalid && read_watched) assert (rdata == expected);
      assert (shown == words && (word & ~bits) == '0);

      // Invariants
      assert (addresses == 4'(address_q) + 4'(bvalid));
      assert (data_words == 4'(data_q) + 4'(bvalid));
      assert (reads == 4'(rvalid));
      if (address_q) assert (write_word_q == address);
      if (data_q) assert (write_data_q == data && strobes_q == strobes);
      assert (awready == !address_q && wready == !data_q && arready == !rvalid);

      cover (answered && is_watched && bresp == 2'b00 && word != word_before);
      cover (answered && is_watched && bresp == 2'b10);
      cover (rvalid && read_watched && rdata == bits);
    end
  end

endmodule
