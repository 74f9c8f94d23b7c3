// Ray core on AXI4, with registers on AXI4-Lite. Rays come by valid/ready, results leave by AXI4 or AXI4-Stream.
//
//   csr                registers: what to draw, counters, flags
//   ray_generator      the rays of a rectangle; a ray's tag is its pixel, {y, x}
//   ray_core
//   axi_read_manager   the core's memory port
//   axi_write_manager  results to memory if register `length` is not 0; else results leave by the stream
//
// AxPROT and AxCACHE are constant. By default accesses are non-secure, unprivileged, to data; memory is normal, not
// cacheable, bufferable, so bridges may merge beats. Writes have ID 0. The user's rays (ray_*) wait while a rectangle
// is drawn or rays are aborted. A generated ray has no t_max and skips no triangle.
module ray_core_axi
  import ray_core_pkg::*;
#(
  parameter int unsigned Rays  = 64,
  parameter int unsigned Depth = 8,
  parameter int unsigned NodeLines     = 256,
  parameter int unsigned TriangleLines = 256,
  parameter int unsigned Clocks = 1,
  parameter int unsigned Exact = 0,
  parameter int unsigned DataWidth = 128,  // width of the AXI4 port, in bits
  parameter int unsigned IdWidth   = 6,
  parameter bit [2:0] AxProt  = 3'b010,
  parameter bit [3:0] AxCache = 4'b0011,
  parameter int unsigned Arith = arith_pkg::Graded
) (
  input  logic                   clk_i,
  input  logic                   rst_ni,
  output logic                   interrupt_o,
  // registers: AXI4-Lite
  input  logic                   s_axil_awvalid,
  output logic                   s_axil_awready,
  input  logic [11:0]            s_axil_awaddr,
  input  logic                   s_axil_wvalid,
  output logic                   s_axil_wready,
  input  logic [31:0]            s_axil_wdata,
  input  logic [3:0]             s_axil_wstrb,
  output logic                   s_axil_bvalid,
  input  logic                   s_axil_bready,
  output logic [1:0]             s_axil_bresp,
  input  logic                   s_axil_arvalid,
  output logic                   s_axil_arready,
  input  logic [11:0]            s_axil_araddr,
  output logic                   s_axil_rvalid,
  input  logic                   s_axil_rready,
  output logic [31:0]            s_axil_rdata,
  output logic [1:0]             s_axil_rresp,
  // memory: AXI4, reads
  output logic                   m_axi_arvalid,
  input  logic                   m_axi_arready,
  output logic [IdWidth-1:0]     m_axi_arid,
  output logic [63:0]            m_axi_araddr,
  output logic [7:0]             m_axi_arlen,
  output logic [2:0]             m_axi_arsize,
  output logic [1:0]             m_axi_arburst,
  output logic [3:0]             m_axi_arcache,
  output logic [2:0]             m_axi_arprot,
  input  logic                   m_axi_rvalid,
  output logic                   m_axi_rready,
  input  logic [IdWidth-1:0]     m_axi_rid,
  input  logic [DataWidth-1:0]   m_axi_rdata,
  input  logic [1:0]             m_axi_rresp,
  input  logic                   m_axi_rlast,
  // rays
  input  logic                   ray_valid_i,
  output logic                   ray_ready_o,
  input  ray_t                   ray_i,
  // results to memory: AXI4, writes
  output logic                   m_axi_awvalid,
  input  logic                   m_axi_awready,
  output logic [IdWidth-1:0]     m_axi_awid,
  output logic [63:0]            m_axi_awaddr,
  output logic [7:0]             m_axi_awlen,
  output logic [2:0]             m_axi_awsize,
  output logic [1:0]             m_axi_awburst,
  output logic [3:0]             m_axi_awcache,
  output logic [2:0]             m_axi_awprot,
  output logic                   m_axi_wvalid,
  input  logic                   m_axi_wready,
  output logic [DataWidth-1:0]   m_axi_wdata,
  output logic [DataWidth/8-1:0] m_axi_wstrb,
  output logic                   m_axi_wlast,
  input  logic                   m_axi_bvalid,
  output logic                   m_axi_bready,
  // verilator lint_off UNUSEDSIGNAL
  input  logic [IdWidth-1:0]     m_axi_bid,  // always 0
  // verilator lint_on UNUSEDSIGNAL
  input  logic [1:0]             m_axi_bresp,
  // results: AXI4-Stream, one per transfer, see registers.md
  output logic                   m_axis_tvalid,
  input  logic                   m_axis_tready,
  output logic [255:0]           m_axis_tdata,
  output logic                   m_axis_tlast
);

  localparam int unsigned ReadIdWidth = read_id_width(NodeLines, TriangleLines);
  localparam logic [31:0] NoTriangle = 32'hffff_ffff;
  localparam logic [31:0] Capability = {  // see registers.md
    4'b0111, 8'(Clocks), 4'($clog2(DataWidth / 8)), 4'(Exact), 4'($clog2(Rays)), 8'd1
  };

  if (Clocks > 255 || Exact > 15) begin : gen_check
    $error("ray_core_axi: expected Clocks of 255 or less, and Exact of 15 or less");
  end

  assign {m_axi_arcache, m_axi_arprot} = {AxCache, AxProt};
  assign {m_axi_awcache, m_axi_awprot} = {AxCache, AxProt};
  assign m_axi_awid = '0;

  // ---- Registers

  logic start, invalidate, abort, drawing, outstanding, camera_busy, bus_error;
  logic result_valid, result_ready, result_fire, is_doubt, ended;
  result_t result;
  logic [63:0] results;
  logic [31:0] length, written;
  logic rewind, writing, full, write_error;
  logic [63:0] base;
  logic [AddressWidth-1:0] lines, error_number;
  logic [31:0] corner, size;
  logic [4*96-1:0] camera;
  logic [NumEvents-1:0] events;
  logic [31:0] in_flight_q;  // number of rays taken whose end has not left

  assign result_fire = result_valid & result_ready;
  assign is_doubt    = result_fire & (result.kind == ResultDoubt);
  assign ended       = result_fire & (result.kind == ResultEnd);

  csr #(
    .Capability(Capability)
  ) u_csr (
    .clk_i,
    .rst_ni,
    .axi_awvalid_i(s_axil_awvalid),
    .axi_awready_o(s_axil_awready),
    .axi_awaddr_i(s_axil_awaddr),
    .axi_wvalid_i(s_axil_wvalid),
    .axi_wready_o(s_axil_wready),
    .axi_wdata_i(s_axil_wdata),
    .axi_wstrb_i(s_axil_wstrb),
    .axi_bvalid_o(s_axil_bvalid),
    .axi_bready_i(s_axil_bready),
    .axi_bresp_o(s_axil_bresp),
    .axi_arvalid_i(s_axil_arvalid),
    .axi_arready_o(s_axil_arready),
    .axi_araddr_i(s_axil_araddr),
    .axi_rvalid_o(s_axil_rvalid),
    .axi_rready_i(s_axil_rready),
    .axi_rdata_o(s_axil_rdata),
    .axi_rresp_o(s_axil_rresp),
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
    .ray_error_i(ended & (result.error != ErrorNone)),
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
    .Arith(Arith)
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

  // ---- Rays: those of the generator have priority

  ray_t generated;
  logic core_ready, core_valid, ray_fire;
  logic closed_q;  // the user's rays wait, except one that is already offered
  assign core_valid   = camera_valid | (ray_valid_i & ~closed_q);
  assign camera_ready = core_ready;
  assign generated = {
    camera[0+:96], camera_direction, Infinity, {2{NoTriangle}}, 1'b0, pixel
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
  logic [LineWidth-1:0] line;

  ray_core #(
    .Rays(Rays),
    .Depth(Depth),
    .NodeLines(NodeLines),
    .TriangleLines(TriangleLines),
    .Clocks(Clocks),
    .Exact(Exact),
    .Arith(Arith)
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
    .axi_arvalid_o(m_axi_arvalid),
    .axi_arready_i(m_axi_arready),
    .axi_arid_o(m_axi_arid),
    .axi_araddr_o(m_axi_araddr),
    .axi_arlen_o(m_axi_arlen),
    .axi_arsize_o(m_axi_arsize),
    .axi_arburst_o(m_axi_arburst),
    .axi_rvalid_i(m_axi_rvalid),
    .axi_rready_o(m_axi_rready),
    .axi_rid_i(m_axi_rid),
    .axi_rdata_i(m_axi_rdata),
    .axi_rresp_i(m_axi_rresp),
    .axi_rlast_i(m_axi_rlast),
    .bus_error_o(bus_error),
    .error_number_o(error_number)
  );

  // ---- Results: 32 bytes each, to memory or the stream

  logic to_memory, record_ready;
  logic [255:0] record;

  assign record = {
    32'(result.tests), result.point, result.t, result.triangle, result.tag,
    32'({result.t_error, result.error, result.found, result.kind})
  };
  assign to_memory       = length != '0;
  assign result_ready    = to_memory ? record_ready : m_axis_tready;
  assign m_axis_tvalid = result_valid & ~to_memory;
  assign m_axis_tdata  = record;
  assign m_axis_tlast  = result.kind == ResultEnd;

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
    .axi_awvalid_o(m_axi_awvalid),
    .axi_awready_i(m_axi_awready),
    .axi_awaddr_o(m_axi_awaddr),
    .axi_awlen_o(m_axi_awlen),
    .axi_awsize_o(m_axi_awsize),
    .axi_awburst_o(m_axi_awburst),
    .axi_wvalid_o(m_axi_wvalid),
    .axi_wready_i(m_axi_wready),
    .axi_wdata_o(m_axi_wdata),
    .axi_wstrb_o(m_axi_wstrb),
    .axi_wlast_o(m_axi_wlast),
    .axi_bvalid_i(m_axi_bvalid),
    .axi_bready_o(m_axi_bready),
    .axi_bresp_i(m_axi_bresp)
  );

endmodule
