// Ray cores behind one port to memory: as ray_core, with as many times the rays.
//
// A ray goes to the next core that has room; requests to memory and results leave in turn. A request's id says which core
// it is of. A line is taken while every core can take one.
//
// SharedLines: of a cache that the cores share, between theirs and memory; 0: none. A request's id is then the cache's entry.
module ray_cores #(
  parameter int unsigned Cores = 2,  // at least 2
  parameter int unsigned Rays  = 64,  // of each, as the rest
  parameter int unsigned Depth = 8,
  parameter int unsigned NodeLines     = 256,
  parameter int unsigned TriangleLines = 256,
  parameter int unsigned Exact = 0,
  parameter int unsigned SharedLines   = 0,  // or a power of two, at least 16
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned CoreWidth = $clog2(Cores),
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth,
  localparam int unsigned IdWidth = 1 + $clog2(
      NodeLines > TriangleLines ? NodeLines : TriangleLines),
  localparam int unsigned ReadIdWidth =
      (SharedLines == 0) ? CoreWidth + IdWidth : $clog2(SharedLines),
  localparam int unsigned LineWidth = ray_core_pkg::LineWidth
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    invalidate_i,
  output logic                    outstanding_o,
  input  logic                    abort_i,
  input  logic [AddressWidth-1:0] lines_i,
  // rays
  input  logic                    ray_valid_i,
  output logic                    ray_ready_o,
  input  ray_core_pkg::ray_t        ray_i,
  // results
  output logic                    result_valid_o,
  input  logic                    result_ready_i,
  output ray_core_pkg::result_t    result_o,
  // memory
  output logic                    read_valid_o,
  input  logic                    read_ready_i,
  output logic [AddressWidth-1:0] read_line_o,
  output logic [ReadIdWidth-1:0]  read_id_o,
  input  logic                    line_valid_i,
  output logic                    line_ready_o,
  input  logic [ReadIdWidth-1:0]  line_id_i,
  input  logic [LineWidth-1:0]    line_i,
  input  logic                    line_error_i,
  output logic [Cores*ray_core_pkg::NumEvents-1:0] events_o  // of each core, the first lowest
);

  localparam int unsigned ReadWidth = AddressWidth + IdWidth;
  localparam int unsigned ResultWidth = $bits(result_o);

  logic [Cores-1:0] ray_valid, ray_ready, result_valid, result_ready, read_valid, read_ready;
  logic [Cores-1:0] line_valid, line_ready, outstanding;
  logic [Cores*ReadWidth-1:0] reads;
  logic [Cores*ResultWidth-1:0] results;
  logic [CoreWidth-1:0] ray_core, ray_first_q, read_core, line_core, unused_result_core;
  logic [IdWidth-1:0] read_id, line_id;
  logic asked, ask_ready, given, given_error;  // between the cores and what is behind them
  logic [AddressWidth-1:0] asked_line;
  logic [LineWidth-1:0] given_line;

  // ---- Rays: among cores with room

  rr_arbiter #(
    .Width(Cores)
  ) u_rays (
    .requests_i(ray_ready),
    .start_i(ray_first_q),
    .valid_o(ray_ready_o),
    .index_o(ray_core)
  );
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) ray_first_q <= '0;
    else if (ray_valid_i && ray_ready_o) ray_first_q <= ray_core + 1'b1;
  end

  // ---- Cores

  assign outstanding_o = outstanding != '0;

  for (genvar n = 0; n < Cores; n++) begin : gen_core
    ray_core_pkg::result_t result;
    logic [AddressWidth-1:0] read_line;
    logic [IdWidth-1:0] id;

    assign ray_valid[n]  = ray_valid_i & ray_ready[n] & (ray_core == CoreWidth'(n));
    assign line_valid[n] = given & (line_ready == '1) & (line_core == CoreWidth'(n));
    assign reads[ReadWidth*n +: ReadWidth] = {read_line, id};
    assign results[ResultWidth*n +: ResultWidth] = result;

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
      .invalidate_i,
      .outstanding_o(outstanding[n]),
      .abort_i,
      .lines_i,
      .ray_valid_i(ray_valid[n]),
      .ray_ready_o(ray_ready[n]),
      .ray_i,
      .result_valid_o(result_valid[n]),
      .result_ready_i(result_ready[n]),
      .result_o(result),
      .read_valid_o(read_valid[n]),
      .read_ready_i(read_ready[n]),
      .read_line_o(read_line),
      .read_id_o(id),
      .line_valid_i(line_valid[n]),
      .line_ready_o(line_ready[n]),
      .line_id_i(line_id),
      .line_i(given_line),
      .line_error_i(given_error),
      .events_o(events_o[ray_core_pkg::NumEvents*n +: ray_core_pkg::NumEvents])
    );
  end

  // ---- Memory

  stream_arbiter #(
    .Width(ReadWidth),
    .Streams(Cores)
  ) u_reads (
    .clk_i,
    .rst_ni,
    .valid_i(read_valid),
    .ready_o(read_ready),
    .data_i(reads),
    .valid_o(asked),
    .ready_i(ask_ready),
    .data_o({asked_line, read_id}),
    .source_o(read_core)
  );

  if (SharedLines == 0) begin : gen_no_cache
    assign read_valid_o         = asked;
    assign ask_ready            = read_ready_i;
    assign read_line_o          = asked_line;
    assign read_id_o            = {read_core, read_id};
    assign given                = line_valid_i;
    assign line_ready_o         = line_ready == '1;
    assign {line_core, line_id} = line_id_i;
    assign given_line           = line_i;
    assign given_error          = line_error_i;
  end else begin : gen_cache
    logic miss, miss_ready, line_here, line_done, line_error, unused_looking;
    logic [ReadIdWidth-1:0] entry, line_entry;
    logic [LineWidth-1:0] line;
    logic [AddressWidth-1:0] number;

    fifo #(
      .Width(1 + ReadIdWidth + LineWidth)
    ) u_lines (
      .clk_i,
      .rst_ni,
      .push_i(line_valid_i & line_ready_o),
      .data_i({line_error_i, line_id_i, line_i}),
      .space_o(line_ready_o),
      .pop_i(line_done),
      .valid_o(line_here),
      .data_o({line_error, line_entry, line})
    );
    line_cache #(
      .Lines(SharedLines),
      .Targets(Cores * Rays),
      .RayWidth(CoreWidth + IdWidth)
    ) u_cache (
      .clk_i,
      .rst_ni,
      .invalidate_i,
      .valid_i(asked),
      .ready_o(ask_ready),
      .demand_i(1'b1),
      .ray_i({read_core, read_id}),
      .line_number_i(asked_line),
      .outstanding_o(unused_looking),
      .miss_valid_o(miss),
      .miss_ready_i(miss_ready),
      .miss_entry_o(entry),
      .miss_number_o(number),
      .fill_i(line_here & (line_ready == '1)),
      .fill_done_o(line_done),
      .fill_entry_i(line_entry),
      .fill_line_i(line),
      .fill_error_i(line_error),
      .valid_o(given),
      .ready_i(line_ready == '1),
      .ray_o({line_core, line_id}),
      .line_o(given_line),
      .error_o(given_error)
    );
    fifo #(
      .Width(AddressWidth + ReadIdWidth)
    ) u_misses (
      .clk_i,
      .rst_ni,
      .push_i(miss & miss_ready),
      .data_i({number, entry}),
      .space_o(miss_ready),
      .pop_i(read_valid_o & read_ready_i),
      .valid_o(read_valid_o),
      .data_o({read_line_o, read_id_o})
    );
  end

  // ---- Results

  stream_arbiter #(
    .Width(ResultWidth),
    .Streams(Cores)
  ) u_results (
    .clk_i,
    .rst_ni,
    .valid_i(result_valid),
    .ready_o(result_ready),
    .data_i(results),
    .valid_o(result_valid_o),
    .ready_i(result_ready_i),
    .data_o(result_o),
    .source_o(unused_result_core)
  );

endmodule
