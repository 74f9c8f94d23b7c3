// Simulates csr with four-state values. Unwritten registers are zero. A counter is read consistently even if it carries
// into its high word between the reads of its two words.
module bench;
  reg  clk = 0, reset_n = 0, arvalid = 0, busy = 0;
  reg  [11:0] address = 0;
  wire [31:0] data;
  wire [63:0] base;
  integer word, cases = 0, failures = 0;

  csr dut (
    .clk_i(clk), .rst_ni(reset_n), .axi_awvalid_i(1'b0), .axi_awready_o(), .axi_awaddr_i(12'd0), .axi_wvalid_i(1'b0),
    .axi_wready_o(), .axi_wdata_i(32'd0), .axi_wstrb_i(4'd0), .axi_bvalid_o(), .axi_bready_i(1'b1), .axi_bresp_o(),
    .axi_arvalid_i(arvalid), .axi_arready_o(), .axi_araddr_i(address), .axi_rvalid_o(), .axi_rready_i(1'b1),
    .axi_rdata_o(data), .axi_rresp_o(), .start_o(), .invalidate_o(), .abort_o(), .drawing_o(),
    .base_o(base), .lines_o(), .corner_o(), .size_o(),
    .camera_o(), .camera_busy_i(1'b0), .core_busy_i(busy), .outstanding_i(1'b0), .doubt_i(1'b0),
    .results_o(), .length_o(), .rewind_o(), .writing_i(1'b0), .written_i(32'd0), .full_i(1'b0), .write_error_i(1'b0),
    .ray_error_i(1'b0), .bus_error_i(1'b0), .error_number_i(28'd0), .events_i(10'd0),
    .interrupt_o()
  );

  task tick;
    begin
      #1 clk = 1;
      #1 clk = 0;
    end
  endtask

  task read(input [11:0] from);
    begin
      address = from;
      arvalid = 1;
      tick;
      arvalid = 0;
      tick;
    end
  endtask

  task expect_data(input [31:0] expected);
    begin
      if (data !== expected) begin
        failures = failures + 1;
        $display("%h: found %h, expected %h", address, data, expected);
      end
      cases = cases + 1;
    end
  endtask

  initial begin
    #1 reset_n = 1;
    for (word = 0; word < 32; word = word + 1) begin
      read(4 * word);
      expect_data(word == 0 ? 32'h52470001 : 0);
    end
    if (base !== 64'd0) failures = failures + 1;
    dut.\gen_counter[0].count_q = 48'h0007_ffff_fffe;
    busy = 1;
    read(12'h100);
    expect_data(32'hffff_fffe);
    read(12'h104);
    expect_data(32'h7);
    read(12'h100);
    read(12'h104);
    expect_data(32'h8);
    $display("%0d cases, %0d failures", cases, failures);
  end
endmodule
