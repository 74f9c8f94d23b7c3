// AXI4 write manager: results of 32 bytes to memory, a burst each.
//
// Result n (0, 1, ...) goes to base_i + 32 n while n is below length_i. Further results wait until rewind_i, which
// makes n 0 again. written_o counts the writes that have been answered; with one AXI ID, answers come in order.
//
// Throughput: a result in 256 / DataWidth clocks, at least 1 (a clock for each beat). On a port of 512 bits a beat uses
// the half that its address selects. No AXI output depends on an input in the same clock.
// Source: AMBA AXI protocol specification, issue E (AXI4): A3.
module axi_write_manager #(
  parameter int unsigned DataWidth = 128,  // 32 to 512, a power of two
  localparam int unsigned RecordWidth = 256
) (
  input  logic                   clk_i,
  input  logic                   rst_ni,
  input  logic [63:0]            base_i,  // a multiple of 64: the lower bits are ignored
  input  logic [31:0]            length_i,  // capacity in results
  input  logic                   rewind_i,  // only while not busy_o
  output logic                   busy_o,  // a result's write has not been answered
  output logic                   full_o,  // a result waits for capacity; all others are written
  output logic                   bus_error_o,  // an answer in this clock has an error
  output logic [31:0]            written_o,
  input  logic                   record_valid_i,
  output logic                   record_ready_o,
  input  logic [RecordWidth-1:0] record_i,
  // AXI4, write address
  output logic                   axi_awvalid_o,
  input  logic                   axi_awready_i,
  output logic [63:0]            axi_awaddr_o,
  output logic [7:0]             axi_awlen_o,
  output logic [2:0]             axi_awsize_o,
  output logic [1:0]             axi_awburst_o,
  // AXI4, write data
  output logic                   axi_wvalid_o,
  input  logic                   axi_wready_i,
  output logic [DataWidth-1:0]   axi_wdata_o,
  output logic [DataWidth/8-1:0] axi_wstrb_o,
  output logic                   axi_wlast_o,
  // AXI4, write response
  input  logic                   axi_bvalid_i,
  output logic                   axi_bready_o,
  input  logic [1:0]             axi_bresp_i
);

  localparam int unsigned BeatWidth = (DataWidth < RecordWidth) ? DataWidth : RecordWidth;
  localparam int unsigned Beats = RecordWidth / BeatWidth;

  if (DataWidth < 32 || DataWidth > 512 || 2 ** $clog2(DataWidth) != DataWidth) begin : gen_check
    $error("axi_write_manager: expected a DataWidth of 32 to 512, a power of two");
  end

  logic [31:0] next_q;
  logic [2:0] left_q;  // beats that follow the offered beat
  logic [RecordWidth-1:0] record_q;
  logic fire, some_room, address_free, data_free;

  assign busy_o         = next_q != written_o;
  assign some_room      = next_q < length_i;
  assign full_o         = record_valid_i & ~some_room & ~busy_o;
  assign address_free   = ~axi_awvalid_o | axi_awready_i;
  assign data_free      = ~axi_wvalid_o | (axi_wready_i & axi_wlast_o);
  assign record_ready_o = some_room & address_free & data_free & ~rewind_i;
  assign fire           = record_valid_i & record_ready_o;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      next_q        <= '0;
      written_o     <= '0;
      axi_awvalid_o <= 1'b0;
      axi_wvalid_o  <= 1'b0;
    end else begin
      next_q        <= rewind_i ? '0 : next_q + 32'(fire);
      written_o     <= rewind_i ? '0 : written_o + 32'(axi_bvalid_i);
      axi_awvalid_o <= fire | ~address_free;
      axi_wvalid_o  <= fire | ~data_free;
    end
  end
  always_ff @(posedge clk_i) begin
    if (fire) begin
      axi_awaddr_o <= {base_i[63:6] + 58'(next_q[31:1]), next_q[0], 5'd0};
      left_q       <= 3'(Beats - 1);
      record_q     <= record_i;
    end else if (axi_wready_i) begin
      left_q   <= left_q - 1'b1;
      record_q <= record_q >> BeatWidth;
    end
  end

  assign axi_awlen_o   = 8'(Beats - 1);
  assign axi_awsize_o  = 3'($clog2(BeatWidth / 8));
  assign axi_awburst_o = 2'b01;  // INCR
  assign axi_wdata_o   = {DataWidth / BeatWidth{record_q[BeatWidth-1:0]}};
  assign axi_wlast_o   = left_q == '0;
  if (DataWidth > RecordWidth) begin : gen_half
    logic upper_q;
    always_ff @(posedge clk_i) if (fire) upper_q <= next_q[0];
    assign axi_wstrb_o = {{32{upper_q}}, {32{~upper_q}}};
  end else begin : gen_whole
    assign axi_wstrb_o = '1;
  end
  assign axi_bready_o  = 1'b1;
  assign bus_error_o   = axi_bvalid_i & axi_bresp_i[1];

  logic unused;  // no access is exclusive, so no answer is EXOKAY
  assign unused = ^{axi_bresp_i[0], base_i[5:0]};

endmodule
