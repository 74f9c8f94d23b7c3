// Ray core on AXI: registers by AXI4-Lite, the scene by AXI4, rays and results as valid/ready.
//
//   csr               what to draw, counters, flags
//   ray_generator     the rays of a rectangle; the tag of each is its pixel, {y, x}
//   ray_core
//   axi_read_manager  its memory port
//
// Rays of the user's (ray_*) wait while a rectangle is drawn or rays are given up. A generated ray has no t_max, skips no triangle,
// and begins at the root. The rest as in those modules.
module ray_core_axi #(
  parameter int unsigned Rays  = 64,
  parameter int unsigned Depth = 8,
  parameter int unsigned NodeLines     = 256,
  parameter int unsigned TriangleLines = 256,
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
  // results
  output logic                   result_valid_o,
  input  logic                   result_ready_i,
  output ray_core_pkg::result_t   result_o
);

  localparam int unsigned ReadIdWidth = 1 + $clog2(
    NodeLines > TriangleLines ? NodeLines : TriangleLines
  );
  localparam logic [30:0] Infinity = 31'h7f80_0000;
  localparam logic [31:0] NoTriangle = 32'hffff_ffff;

  // ---- Registers

  logic start, invalidate, abort, drawing, outstanding, camera_busy, bus_error;
  logic result_fire, is_doubt, ended;
  logic [63:0] base;
  logic [AddressWidth-1:0] lines, error_number;
  logic [31:0] corner, size;
  logic [4*96-1:0] camera;
  logic [ray_core_pkg::NumEvents-1:0] events;
  logic [31:0] in_flight_q;  // rays ray_fire whose end has not been given

  assign result_fire = result_valid_o & result_ready_i;
  assign is_doubt    = result_fire & (result_o.kind == ray_core_pkg::ResultDoubt);
  assign ended       = result_fire & (result_o.kind == ray_core_pkg::ResultEnd);

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
    .camera_busy_i(camera_busy),
    .core_busy_i(in_flight_q != '0),
    .outstanding_i(outstanding),
    .doubt_i(is_doubt),
    .ray_error_i(ended & (result_o.error != ray_core_pkg::ErrorNone)),
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
    camera[0+:96], camera_direction, Infinity, NoTriangle, AddressWidth'(0), 2'b00, pixel
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
    .result_valid_o,
    .result_ready_i,
    .result_o,
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

endmodule
