// Simulates ray_core with four-state values, at power-up and after resets in mid-run. No valid output bit is unknown.
// Rays have the right hits. Memory has two nodes and three triangles across the x axis. Every eighth ray meets an edge.
module bench;
  parameter IdWidth = 5;  // bits of a line request's ID
  parameter Exact = 0;  // parameter Exact of dut
  reg clk = 0, reset_n = 0, ray = 0, result_ready = 0, read_ready = 0, line_valid = 0;
  reg [95:0] origin = 0;
  reg [31:0] skip = 0, source = 0, tag = 0;
  reg [IdWidth-1:0] line_id = 0;
  reg [511:0] line = 0;
  wire ray_ready, result, kind, found, read, line_ready, outstanding;
  wire [31:0] result_tag, triangle, t;
  wire [4:0] t_error;
  wire [IdWidth-1:0] read_id;
  wire [95:0] point;
  wire [27:0] tests, read_line;
  wire [2:0] error;
  wire [10:0] events;

  ray_core dut (
    .clk_i(clk), .rst_ni(reset_n), .invalidate_i(1'b0), .outstanding_o(outstanding), .abort_i(1'b0), .lines_i(28'd5),
    .ray_valid_i(ray), .ray_ready_o(ray_ready),
    .ray_i({origin, 64'd0, 32'h3f800000, 31'h7f800000, skip, source, 1'd0, tag}), .result_valid_o(result),
    .result_ready_i(result_ready),
    .result_o({kind, result_tag, found, triangle, t, t_error, point, tests, error}),
    .read_valid_o(read),
    .read_ready_i(read_ready), .read_line_o(read_line), .read_id_o(read_id), .line_valid_i(line_valid),
    .line_ready_o(line_ready), .line_id_i(line_id), .line_i(line), .line_error_i(1'b0), .events_o(events)
  );

  // Returns a node with a grid of 1/32 from the origin. box_0, box_1: first two children, {high, low}, each {z, y, x}.
  function [511:0] node(input [27:0] base, input [7:0] kinds, input [47:0] box_0, input [47:0] box_1);
    node = {240'd0, box_1, box_0, 20'd0, kinds, base, 24'h7a7a7a, 96'd0};
  endfunction

  // Returns the primitive index of the triangle in a line: with Exact the line number, else another number.
  function [31:0] name(input [31:0] line_number);
    name = Exact != 0 ? line_number : line_number + 8;
  endfunction

  // Returns a right-angled triangle at x, with the right angle at (x, from, from) and legs of length to - from.
  function [511:0] across(input [31:0] index, input [31:0] x, input [31:0] from, input [31:0] to);
    across = {192'd0, index, to, from, x, from, to, x, from, from, x};
  endfunction

  reg [511:0] lines[0:4];
  reg [28+IdWidth-1:0] asked[0:63];  // {line, id}
  integer first, last;     // range of entries of `asked` that are to be answered

  task known(input value, input is_known);
    if (value !== 1'b0 && !is_known) failures = failures + 1;
  endtask

  integer round, seed = 1, sent, ended, cases = 0, failures = 0, doubts = 0, clocks, most;
  reg [31:0] want, want_t;
  reg take_ray, take_line, take_read;

  task tick;
    begin
      result_ready = $random(seed);
      read_ready = $random(seed);
      if (!ray && sent < 24 && $random(seed) % 2 == 0) begin
        ray = 1;
        tag = sent;
        skip = sent % 8 == 3 ? name(3) : 99;
        source = sent % 8 == 7 ? name(3) : 99;
        origin = {sent % 8 == 5 ? 64'h40900000_40800000 : sent % 4 == 1 ? 64'h40900000_40900000 : sent % 4 == 2 ? 64'h40f00000_40f00000
                  : 64'h3f800000_3f800000, 32'hbf800000};
        sent = sent + 1;
      end
      if (!line_valid && first != last && $random(seed) % 4 == 0) begin
        line_valid = 1;
        {line, line_id} = {lines[asked[first][IdWidth+:3]], asked[first][IdWidth-1:0]};
        first = (first + 1) % 64;
      end
      #1;
      known(1'b1, ^{ray_ready, result, read, line_ready, outstanding, events} !== 1'bx);
      known(read, ^{read_line, read_id} !== 1'bx);
      known(result, ^{kind, result_tag, found, triangle, t, t_error, point, tests, error} !== 1'bx);
      if (read && read_line > 4) failures = failures + 1;
      if (result && result_ready && kind == 1) begin
        doubts = doubts + 1;
        if (result_tag % 8 != 5 || triangle !== name(4)) failures = failures + 1;
      end
      if (result && result_ready && kind == 0) begin
        want   = result_tag % 4 == 0 ? name(3) : result_tag % 4 == 1 ? name(4) : name(2);
        want_t = result_tag % 4 == 0 ? 32'h40400000 : result_tag % 4 == 1 ? 32'h40c00000 : 32'h40800000;
        if (result_tag % 8 != 5 && (found !== (result_tag % 4 != 2) || (found && (triangle !== want || t !== want_t)))
            || error !== 0) begin
          failures = failures + 1;
          $display("ray %0d: found %b %0d %h %0d", result_tag, found, triangle, t, error);
        end
        ended = ended + 1;
        cases = cases + 1;
      end
      take_ray  = ray & ray_ready;
      take_line = line_valid & line_ready;
      take_read = read & read_ready;
      if (take_read) begin
        asked[last] = {read_line, read_id};
        last = (last + 1) % 64;
      end
      #1 clk = 1;
      #1 clk = 0;
      if (take_ray) ray = 0;
      if (take_line) line_valid = 0;
    end
  endtask

  initial begin
    lines[0] = node(1, 8'h18, 48'hffffff_000000, 48'h808060_000060);
    lines[1] = node(3, 8'h02, 48'he0e0a0_000040, 48'd0);
    lines[2] = across(name(2), 32'h40400000, 32'd0, 32'h40800000);
    lines[3] = across(name(3), 32'h40000000, 32'd0, 32'h40800000);
    lines[4] = across(name(4), 32'h40a00000, 32'h40800000, 32'h40e00000);
    for (round = 0; round < 6; round = round + 1) begin
      reset_n = 0;
      {ray, line_valid} = 0;
      {sent, ended, first, last} = 0;
      #1 reset_n = 1;
      most = round % 2 == 0 ? 100 + 40 * round : 3000;  // every other round stops early
      for (clocks = 0; clocks < most && ended < 24; clocks = clocks + 1) tick;
      if (round % 2 == 1 && ended != 24) failures = failures + 1;
      if (round % 2 == 0) cases = cases - ended;
    end
    if ((doubts == 0) != (Exact != 0)) failures = failures + 1;
    $display("%0d cases, %0d failures", cases, failures);
  end
endmodule
