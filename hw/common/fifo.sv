// Queue of Depth words, in registers or, with Memory, in a ram.
//
// Latency: 1 clock, or 2 with Memory (the first word moves to the ram's output). Throughput: one word a clock.
// push_i requires a free word; pop_i requires valid_o. space_o is high while more than Reserve words are free. Reserve
// is the number of words that a writer may still push after space_o has fallen. space_o and valid_o are registers.
module fifo #(
  parameter int unsigned Width   = 32,
  parameter int unsigned Depth   = 2,
  parameter int unsigned Reserve = 0,  // below Depth
  parameter bit          Memory  = 1'b0
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
    $error("fifo: expected a Depth of 2 or more and a Reserve below it");
  end

  logic [IndexWidth-1:0] write_q, read_q;
  logic [CountWidth-1:0] count_q, count_d;  // including the word at the memory's output
  logic read, valid_d;

  always_comb begin
    count_d = count_q;
    if (push_i && !pop_i) count_d = count_q + 1'b1;
    if (pop_i && !push_i) count_d = count_q - 1'b1;
  end

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
      valid_o <= valid_d;
      space_o <= count_d < CountWidth'(Depth - Reserve);
    end
  end

  if (Memory) begin : gen_memory
    assign read    = (count_q != CountWidth'(valid_o)) & (~valid_o | pop_i);
    assign valid_d = read | (valid_o & ~pop_i);

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
  end else begin : gen_registers
    logic [Width-1:0] words[Depth];

    assign read    = pop_i;
    assign valid_d = count_d != '0;
    assign data_o  = words[read_q];

    always_ff @(posedge clk_i) if (push_i) words[write_q] <= data_i;
  end

endmodule
