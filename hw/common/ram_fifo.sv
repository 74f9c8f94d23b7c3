// First-in first-out queue of Depth words in a memory with a clock.
//
// As fifo, but that a word pushed into an empty queue is at data_o a clock later than there: the first word waits at
// the memory's output, the others in it. Throughput one word a clock. No combinational path from pop_i to space_o and
// valid_o.
module ram_fifo #(
  parameter int unsigned Width   = 32,
  parameter int unsigned Depth   = 64,
  parameter int unsigned Reserve = 0    // below Depth
) (
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             push_i,
  input  logic [Width-1:0] data_i,
  output logic             space_o,
  input  logic             pop_i,
  output logic             valid_o,
  output logic [Width-1:0] data_o
);

  localparam int unsigned IndexWidth = (Depth < 2) ? 1 : $clog2(Depth);
  localparam int unsigned CountWidth = $clog2(Depth + 1);
  localparam logic [IndexWidth-1:0] Last = IndexWidth'(Depth - 1);

  if (Depth < 2 || Reserve >= Depth) begin : gen_check
    $error("ram_fifo: expected a Depth of 2 or more and a Reserve below it");
  end

  logic [IndexWidth-1:0] write_q, read_q;
  logic [CountWidth-1:0] count_q, count_d;  // with the one at the output
  logic read;

  assign count_d = count_q + CountWidth'(push_i) - CountWidth'(pop_i);
  assign read    = (count_q != CountWidth'(valid_o)) & (~valid_o | pop_i);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      write_q <= '0;
      read_q  <= '0;
      count_q <= '0;
      valid_o <= 1'b0;
      space_o <= 1'b1;
    end else begin
      if (push_i) write_q <= (write_q == Last) ? '0 : write_q + 1'b1;
      if (read) read_q <= (read_q == Last) ? '0 : read_q + 1'b1;
      count_q <= count_d;
      valid_o <= read | (valid_o & ~pop_i);
      space_o <= count_d < CountWidth'(Depth - Reserve);
    end
  end

  ram #(
    .Width(Width),
    .Depth(Depth)
  ) u_words (
    .clk_i,
    .write_i(push_i),
    .write_address_i(write_q),
    .data_i,
    .read_i(read),
    .read_address_i(read_q),
    .data_o
  );

endmodule
