// AXI4 read manager: the core's memory port, a burst for each line.
//
// A line's burst begins at a multiple of 64 bytes, so no burst crosses 4 KiB. Each burst in flight has its own AXI ID,
// so bursts may be answered in any order, with their beats interleaved. base_i is the address of line 0.
//
// At most 2**IdWidth lines are outstanding; further requests wait. Latency: 1 clock (from a line's last beat until it
// is offered). bus_error_o: a beat of line error_number_o came with an error, or with a wrong RLAST; the line is then
// offered with line_error_o. No AXI output depends on an input in the same clock.
// Source: AMBA AXI protocol specification, issue E (AXI4): A3.3 on handshakes, A5 on IDs.
module axi_read_manager
  import ray_core_pkg::*;
#(
  parameter int unsigned DataWidth = 128,  // 32 to 512, a power of two
  parameter int unsigned IdWidth   = 6,
  parameter int unsigned ReadIdWidth = 9  // as in ray_core
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic [63:0]             base_i,  // a multiple of 64: the lower bits are ignored
  // the core's side
  input  logic                    read_valid_i,
  output logic                    read_ready_o,
  input  logic [AddressWidth-1:0] read_line_i,
  input  logic [ReadIdWidth-1:0]  read_id_i,
  output logic                    line_valid_o,
  input  logic                    line_ready_i,
  output logic [ReadIdWidth-1:0]  line_id_o,
  output logic [LineWidth-1:0]    line_o,
  output logic                    line_error_o,  // line_o is invalid
  // AXI4, read address
  output logic                    axi_arvalid_o,
  input  logic                    axi_arready_i,
  output logic [IdWidth-1:0]      axi_arid_o,
  output logic [63:0]             axi_araddr_o,
  output logic [7:0]              axi_arlen_o,
  output logic [2:0]              axi_arsize_o,
  output logic [1:0]              axi_arburst_o,
  // AXI4, read data
  input  logic                    axi_rvalid_i,
  output logic                    axi_rready_o,
  input  logic [IdWidth-1:0]      axi_rid_i,
  input  logic [DataWidth-1:0]    axi_rdata_i,
  input  logic [1:0]              axi_rresp_i,
  input  logic                    axi_rlast_i,
  output logic                    bus_error_o,
  output logic [AddressWidth-1:0] error_number_o
);

  localparam int unsigned Ids = 2 ** IdWidth;
  localparam int unsigned Beats = LineWidth / DataWidth;
  localparam int unsigned BeatWidth = (Beats == 1) ? 1 : $clog2(Beats);
  localparam logic [1:0] BurstIncrement = 2'b01;

  if (Beats * DataWidth != LineWidth || DataWidth % 32 != 0 || IdWidth < 1) begin : gen_check
    $error("axi_read_manager: expected a DataWidth of 32, 64, ... 512 and an IdWidth of 1 or more");
  end

  // ---- Requests: a free ID for each

  logic [Ids-1:0] free_q;
  logic [IdWidth-1:0] id;
  logic some_free, load, request_fire, line_load;
  logic beat_valid, beat_fire, beat_error, beat_last, last;
  logic [IdWidth-1:0] beat_id;
  logic [ReadIdWidth-1:0] read_ids[Ids];
  logic [AddressWidth-1:0] numbers[Ids];
  logic [Ids-1:0] errors_q;  // a beat came with an error

  rr_arbiter #(
    .Width(Ids)
  ) u_pick (
    .requests_i(free_q),
    .start_i('0),
    .valid_o(some_free),
    .index_o(id)
  );
  assign load         = ~axi_arvalid_o | axi_arready_i;
  assign read_ready_o = load & some_free;
  assign request_fire = read_valid_i & read_ready_o;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      free_q        <= '1;
      axi_arvalid_o <= 1'b0;
    end else begin
      if (request_fire) free_q[id] <= 1'b0;
      if (beat_fire && last) free_q[beat_id] <= 1'b1;
      if (load) axi_arvalid_o <= request_fire;
    end
  end
  always_ff @(posedge clk_i) begin
    if (request_fire) begin
      read_ids[id] <= read_id_i;
      numbers[id]  <= read_line_i;
      axi_arid_o   <= id;
      axi_araddr_o <= {base_i[63:6] + 58'(read_line_i), 6'd0};
    end
  end
  assign axi_arlen_o   = 8'(Beats - 1);
  assign axi_arsize_o  = 3'($clog2(DataWidth / 8));
  assign axi_arburst_o = BurstIncrement;

  // ---- Beats: beat b of a line waits in memory b for the line's last beat

  logic [DataWidth-1:0] beat, last_beat_q;

  fifo #(
    .Width(2 + IdWidth + DataWidth),
    .Depth(2)
  ) u_beats (
    .clk_i,
    .rst_ni,
    .push_i(axi_rvalid_i & axi_rready_o),
    .data_i({axi_rresp_i[1], axi_rlast_i, axi_rid_i, axi_rdata_i}),
    .space_o(axi_rready_o),
    .pop_i(beat_fire),
    .valid_o(beat_valid),
    .data_o({beat_error, beat_last, beat_id, beat})
  );

  logic [BeatWidth-1:0] counts[Ids];  // beats received; 0 when the ID is allocated
  assign last = counts[beat_id] == BeatWidth'(Beats - 1);
  assign line_o[LineWidth-1-:DataWidth] = last_beat_q;
  for (genvar b = 0; b + 1 < Beats; b++) begin : gen_beat
    ram #(
      .Width(DataWidth),
      .Depth(Ids)
    ) u_part (
      .clk_i,
      .write_i(beat_fire & counts[beat_id] == BeatWidth'(b)),
      .write_address_i(beat_id),
      .data_i(beat),
      .read_i(beat_fire & last),
      .read_address_i(beat_id),
      .data_o(line_o[DataWidth*b+:DataWidth])
    );
  end

  always_ff @(posedge clk_i) begin
    if (request_fire) counts[id] <= '0;
    if (request_fire) errors_q[id] <= 1'b0;
    if (bus_error_o) errors_q[beat_id] <= 1'b1;
    if (beat_fire && !last) counts[beat_id] <= counts[beat_id] + 1'b1;
  end

  assign line_load      = ~line_valid_o | line_ready_i;
  assign beat_fire      = beat_valid & (~last | line_load);
  assign bus_error_o    = beat_fire & (beat_error | (beat_last != last));
  assign error_number_o = numbers[beat_id];

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) line_valid_o <= 1'b0;
    else if (line_load) line_valid_o <= beat_fire & last;
  end
  always_ff @(posedge clk_i) begin
    if (beat_fire && last) begin
      line_id_o    <= read_ids[beat_id];
      line_error_o <= errors_q[beat_id] | bus_error_o;
      last_beat_q  <= beat;
    end
  end

  logic unused;  // no access is exclusive, so no answer is EXOKAY
  assign unused = ^{axi_rresp_i[0], base_i[5:0]};

endmodule
