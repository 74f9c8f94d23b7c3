// Ray core on AXI: registers by AXI4-Lite, the scene by AXI4, rays as valid/ready, results by AXI4 or AXI4-Stream.
//
//   csr                what to draw, counters, flags
//   ray_generator      the rays of a rectangle; the tag of each is its pixel, {y, x}
//   ray_core
//   axi_read_manager   its memory port
//   axi_write_manager  results to memory, where register `length` is not 0; else they leave by the stream
//
// Rays of the user's (ray_*) wait while a rectangle is drawn or rays are given up. A generated ray has no t_max, skips no triangle,
// and begins at the root. The rest as in those modules.
module ray_core_axi #(
  parameter int unsigned Rays  = 64,
  parameter int unsigned Depth = 8,
  parameter int unsigned NodeLines     = 256,
  parameter int unsigned TriangleLines = 256,
  parameter int unsigned Exact = 0,
  parameter int unsigned DataWidth = 128,  // of the AXI4 port
  parameter int unsigned IdWidth   = 6,
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned RegisterAddressWidth = 12,
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth
) (
  input  logic                   clk_i,
  input  logic                   rst_ni,
  output logic                   interrupt_o,
  // registers: AXI4-Lite
  input  logic                   reg_awvalid_i,
  output logic                   reg_awready_o,
  input  logic [RegisterAddressWidth-1:0] reg_awaddr_i,
  input  logic                   reg_wvalid_i,
  output logic                   reg_wready_o,
  input  logic [31:0]            reg_wdata_i,
  input  logic [3:0]             reg_wstrb_i,
  output logic                   reg_bvalid_o,
  input  logic                   reg_bready_i,
  output logic [1:0]             reg_bresp_o,
  input  logic                   reg_arvalid_i,
  output logic                   reg_arready_o,
  input  logic [RegisterAddressWidth-1:0] reg_araddr_i,
  output logic                   reg_rvalid_o,
  input  logic                   reg_rready_i,
  output logic [31:0]            reg_rdata_o,
  output logic [1:0]             reg_rresp_o,
  // memory: AXI4, reads
  output logic                   mem_arvalid_o,
  input  logic                   mem_arready_i,
  output logic [IdWidth-1:0]     mem_arid_o,
  output logic [63:0]            mem_araddr_o,
  output logic [7:0]             mem_arlen_o,
  output logic [2:0]             mem_arsize_o,
  output logic [1:0]             mem_arburst_o,
  output logic [2:0]             mem_arprot_o,
  input  logic                   mem_rvalid_i,
  output logic                   mem_rready_o,
  input  logic [IdWidth-1:0]     mem_rid_i,
  input  logic [DataWidth-1:0]   mem_rdata_i,
  input  logic [1:0]             mem_rresp_i,
  input  logic                   mem_rlast_i,
  // rays
  input  logic                   ray_valid_i,
  output logic                   ray_ready_o,
  input  ray_core_pkg::ray_t       ray_i,
  // results to memory: AXI4, writes
  output logic                   mem_awvalid_o,
  input  logic                   mem_awready_i,
  output logic [63:0]            mem_awaddr_o,
  output logic [7:0]             mem_awlen_o,
  output logic [2:0]             mem_awsize_o,
  output logic [1:0]             mem_awburst_o,
  output logic [2:0]             mem_awprot_o,
  output logic                   mem_wvalid_o,
  input  logic                   mem_wready_i,
  output logic [DataWidth-1:0]   mem_wdata_o,
  output logic [DataWidth/8-1:0] mem_wstrb_o,
  output logic                   mem_wlast_o,
  input  logic                   mem_bvalid_i,
  output logic                   mem_bready_o,
  input  logic [1:0]             mem_bresp_i,
  // results: AXI4-Stream, a record a transfer, see registers.md
  output logic                   stream_tvalid_o,
  input  logic                   stream_tready_i,
  output logic [255:0]           stream_tdata_o,
  output logic                   stream_tlast_o
);

  localparam int unsigned ReadIdWidth = 1 + $clog2(
    NodeLines > TriangleLines ? NodeLines : TriangleLines
  );
  localparam logic [30:0] Infinity = 31'h7f80_0000;
  localparam logic [31:0] NoTriangle = 32'hffff_ffff;

  // ---- Registers

  logic start, invalidate, abort, drawing, outstanding, camera_busy, bus_error;
  logic result_valid, result_ready, result_fire, is_doubt, ended;
  ray_core_pkg::result_t result;
  logic [63:0] results;
  logic [31:0] length, written;
  logic rewind, writing, full, write_error;
  logic [63:0] base;
  logic [AddressWidth-1:0] lines, error_number;
  logic [31:0] corner, size;
  logic [4*96-1:0] camera;
  logic [ray_core_pkg::NumEvents-1:0] events;
  logic [31:0] in_flight_q;  // rays ray_fire whose end has not been given

  assign result_fire = result_valid & result_ready;
  assign is_doubt    = result_fire & (result.kind == ray_core_pkg::ResultDoubt);
  assign ended       = result_fire & (result.kind == ray_core_pkg::ResultEnd);

  csr u_csr (
    .clk_i,
    .rst_ni,
    .axi_awvalid_i(reg_awvalid_i),
    .axi_awready_o(reg_awready_o),
    .axi_awaddr_i(reg_awaddr_i),
    .axi_wvalid_i(reg_wvalid_i),
    .axi_wready_o(reg_wready_o),
    .axi_wdata_i(reg_wdata_i),
    .axi_wstrb_i(reg_wstrb_i),
    .axi_bvalid_o(reg_bvalid_o),
    .axi_bready_i(reg_bready_i),
    .axi_bresp_o(reg_bresp_o),
    .axi_arvalid_i(reg_arvalid_i),
    .axi_arready_o(reg_arready_o),
    .axi_araddr_i(reg_araddr_i),
    .axi_rvalid_o(reg_rvalid_o),
    .axi_rready_i(reg_rready_i),
    .axi_rdata_o(reg_rdata_o),
    .axi_rresp_o(reg_rresp_o),
    .start_o(start),
    .invalidate_o(invalidate),
    .abort_o(abort),
    .drawing_o(drawing),
    .base_o(base),
    .lines_o(lines),
    .corner_o(corner),
    .size_o(size),
    .camera_o(camera),
    .results_o(results),
    .length_o(length),
    .rewind_o(rewind),
    .camera_busy_i(camera_busy),
    .core_busy_i(writing | (in_flight_q != '0)),
    .outstanding_i(outstanding),
    .writing_i(writing),
    .written_i(written),
    .doubt_i(is_doubt),
    .ray_error_i(ended & (result.error != ray_core_pkg::ErrorNone)),
    .full_i(full),
    .write_error_i(write_error),
    .bus_error_i(bus_error),
    .error_number_i(error_number),
    .events_i(events),
    .interrupt_o
  );

  // ---- Camera

  logic camera_valid, camera_ready;
  logic [95:0] camera_direction;
  logic [31:0] pixel;

  ray_generator #(
    .Arith(Arith),
    .Adder(Adder)
  ) u_generator (
    .clk_i,
    .rst_ni,
    .first_i(camera[96 +: 96]),
    .right_i(camera[192 +: 96]),
    .down_i(camera[288 +: 96]),
    .start_i(start),
    .stop_i(abort),
    .x_i(corner[15:0]),
    .y_i(corner[31:16]),
    .width_i(size[15:0]),
    .height_i(size[31:16]),
    .busy_o(camera_busy),
    .valid_o(camera_valid),
    .ready_i(camera_ready),
    .direction_o(camera_direction),
    .pixel_o(pixel)
  );

  // ---- Rays: the camera's first

  ray_core_pkg::ray_t generated;
  logic core_ready, core_valid, ray_fire;
  logic closed_q;  // to the user's; but one that waits goes in before
  assign core_valid   = camera_valid | (ray_valid_i & ~closed_q);
  assign camera_ready = core_ready;
  assign generated = {
    camera[0+:96], camera_direction, Infinity, {2{NoTriangle}}, 2'b00, pixel
  };
  assign ray_ready_o  = core_ready & ~closed_q;
  assign ray_fire     = core_valid & core_ready;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      in_flight_q <= '0;
      closed_q    <= 1'b0;
    end else begin
      if (!core_valid || core_ready) closed_q <= start | drawing | abort;
      in_flight_q <= in_flight_q + 32'(ray_fire) - 32'(ended);
    end
  end

  // ---- The core and its memory

  logic read_valid, read_ready, line_valid, line_ready, line_error;
  logic [AddressWidth-1:0] read_line;
  logic [ReadIdWidth-1:0] read_id, line_id;
  logic [ray_core_pkg::LineWidth-1:0] line;

  ray_core #(
    .Rays(Rays),
    .Depth(Depth),
    .NodeLines(NodeLines),
    .TriangleLines(TriangleLines),
    .Exact(Exact),
    .Arith(Arith),
    .Adder(Adder)
  ) u_core (
    .clk_i,
    .rst_ni,
    .invalidate_i(invalidate),
    .outstanding_o(outstanding),
    .abort_i(abort),
    .lines_i(lines),
    .ray_valid_i(core_valid),
    .ray_ready_o(core_ready),
    .ray_i(camera_valid ? generated : ray_i),
    .result_valid_o(result_valid),
    .result_ready_i(result_ready),
    .result_o(result),
    .read_valid_o(read_valid),
    .read_ready_i(read_ready),
    .read_line_o(read_line),
    .read_id_o(read_id),
    .line_valid_i(line_valid),
    .line_ready_o(line_ready),
    .line_id_i(line_id),
    .line_i(line),
    .line_error_i(line_error),
    .events_o(events)
  );

  axi_read_manager #(
    .DataWidth(DataWidth),
    .IdWidth(IdWidth),
    .ReadIdWidth(ReadIdWidth)
  ) u_read_manager (
    .clk_i,
    .rst_ni,
    .base_i(base),
    .read_valid_i(read_valid),
    .read_ready_o(read_ready),
    .read_line_i(read_line),
    .read_id_i(read_id),
    .line_valid_o(line_valid),
    .line_ready_i(line_ready),
    .line_id_o(line_id),
    .line_o(line),
    .line_error_o(line_error),
    .axi_arvalid_o(mem_arvalid_o),
    .axi_arready_i(mem_arready_i),
    .axi_arid_o(mem_arid_o),
    .axi_araddr_o(mem_araddr_o),
    .axi_arlen_o(mem_arlen_o),
    .axi_arsize_o(mem_arsize_o),
    .axi_arburst_o(mem_arburst_o),
    .axi_arprot_o(mem_arprot_o),
    .axi_rvalid_i(mem_rvalid_i),
    .axi_rready_o(mem_rready_o),
    .axi_rid_i(mem_rid_i),
    .axi_rdata_i(mem_rdata_i),
    .axi_rresp_i(mem_rresp_i),
    .axi_rlast_i(mem_rlast_i),
    .bus_error_o(bus_error),
    .error_number_o(error_number)
  );

  // ---- Results: a record each, to memory or by the stream

  logic to_memory, record_ready;
  logic [255:0] record;

  assign record = {
    32'(result.tests), result.point, result.t, result.triangle, result.tag,
    32'({result.t_error, result.error, result.found, result.kind})
  };
  assign to_memory       = length != '0;
  assign result_ready    = to_memory ? record_ready : stream_tready_i;
  assign stream_tvalid_o = result_valid & ~to_memory;
  assign stream_tdata_o  = record;
  assign stream_tlast_o  = result.kind == ray_core_pkg::ResultEnd;

  axi_write_manager #(
    .DataWidth(DataWidth)
  ) u_write_manager (
    .clk_i,
    .rst_ni,
    .base_i(results),
    .length_i(length),
    .rewind_i(rewind),
    .busy_o(writing),
    .full_o(full),
    .bus_error_o(write_error),
    .written_o(written),
    .record_valid_i(result_valid & to_memory),
    .record_ready_o(record_ready),
    .record_i(record),
    .axi_awvalid_o(mem_awvalid_o),
    .axi_awready_i(mem_awready_i),
    .axi_awaddr_o(mem_awaddr_o),
    .axi_awlen_o(mem_awlen_o),
    .axi_awsize_o(mem_awsize_o),
    .axi_awburst_o(mem_awburst_o),
    .axi_awprot_o(mem_awprot_o),
    .axi_wvalid_o(mem_wvalid_o),
    .axi_wready_i(mem_wready_i),
    .axi_wdata_o(mem_wdata_o),
    .axi_wstrb_o(mem_wstrb_o),
    .axi_wlast_o(mem_wlast_o),
    .axi_bvalid_i(mem_bvalid_i),
    .axi_bready_o(mem_bready_o),
    .axi_bresp_i(mem_bresp_i)
  );

endmodule
