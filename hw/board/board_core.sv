// Ray core for a board, with an SDRAM and a host link. Rays, lines and results are words on the link.
//
// core_link's header defines the words, sdram_controller's the SDRAM and the limits of clk_i. Reads of memory return no
// errors, so a host must send all lines that a tree refers to.
module board_core
  import ray_core_pkg::*;
#(
  parameter int unsigned ClockMhz      = 40,
  parameter int unsigned Rays          = 16,
  parameter int unsigned Depth         = 4,
  parameter int unsigned NodeLines     = 64,
  parameter int unsigned TriangleLines = 64,
  parameter int unsigned Clocks        = 11,
  parameter int unsigned Arith         = arith_pkg::Behavioural
) (
  input  logic        clk_i,
  input  logic        rst_ni,
  input  logic        word_valid_i,
  output logic        word_ready_o,
  input  logic [31:0] word_i,
  input  logic        break_i,  // see core_link
  output logic        word_valid_o,
  input  logic        word_ready_i,
  output logic [31:0] word_o,
  output logic        sdram_ras_no,
  output logic        sdram_cas_no,
  output logic        sdram_we_no,
  output logic [1:0]  sdram_bank_o,
  output logic [12:0] sdram_address_o,
  output logic        sdram_drive_o,
  output logic [15:0] sdram_data_o,
  input  logic [15:0] sdram_data_i
);

  localparam int unsigned ReadIdWidth = read_id_width(NodeLines, TriangleLines);

  logic invalidate, abort, outstanding, ray_valid, ray_ready, result_valid, result_ready;
  logic read_valid, read_ready, line_valid, line_ready, write_valid, write_ready;
  logic [AddressWidth-1:0] lines, read_line, write_line;
  logic [ReadIdWidth-1:0] read_id, line_id;
  logic [LineWidth-1:0] line, write_data;
  ray_t ray;
  result_t result;

  core_link u_link (
    .clk_i,
    .rst_ni,
    .word_valid_i,
    .word_ready_o,
    .word_i,
    .break_i,
    .word_valid_o,
    .word_ready_i,
    .word_o,
    .write_valid_o(write_valid),
    .write_ready_i(write_ready),
    .write_line_o(write_line),
    .write_data_o(write_data),
    .invalidate_o(invalidate),
    .abort_o(abort),
    .outstanding_i(outstanding),
    .lines_o(lines),
    .ray_valid_o(ray_valid),
    .ray_ready_i(ray_ready),
    .ray_o(ray),
    .result_valid_i(result_valid),
    .result_ready_o(result_ready),
    .result_i(result)
  );

  ray_core #(
    .Rays(Rays),
    .Depth(Depth),
    .NodeLines(NodeLines),
    .TriangleLines(TriangleLines),
    .Clocks(Clocks),
    .Arith(Arith)
  ) u_core (
    .clk_i,
    .rst_ni,
    .invalidate_i(invalidate),
    .outstanding_o(outstanding),
    .abort_i(abort),
    .lines_i(lines),
    .ray_valid_i(ray_valid),
    .ray_ready_o(ray_ready),
    .ray_i(ray),
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
    .line_error_i(1'b0),
    .events_o()
  );

  sdram_controller #(
    .ClockMhz(ClockMhz),
    .IdWidth(ReadIdWidth)
  ) u_sdram (
    .clk_i,
    .rst_ni,
    .read_valid_i(read_valid),
    .read_ready_o(read_ready),
    .read_line_i(read_line),
    .read_id_i(read_id),
    .line_valid_o(line_valid),
    .line_ready_i(line_ready),
    .line_id_o(line_id),
    .line_o(line),
    .write_valid_i(write_valid),
    .write_ready_o(write_ready),
    .write_line_i(write_line),
    .write_data_i(write_data),
    .sdram_ras_no,
    .sdram_cas_no,
    .sdram_we_no,
    .sdram_bank_o,
    .sdram_address_o,
    .sdram_drive_o,
    .sdram_data_o,
    .sdram_data_i
  );

endmodule
