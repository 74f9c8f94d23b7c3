// First-in first-out queue of 2**LogDepth words. No combinational path from pop_i to the space seen
// by the writer: space_o is a register, and true as long as one more word fits.
//
// A word pushed at one clock edge is at data_o after it; throughput one word a clock. push_i is

module fifo #(
  parameter int unsigned Width    = 32,
  parameter int unsigned LogDepth = 1
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

  localparam int unsigned Depth = 2 ** LogDepth;

  logic [Width-1:0] words[Depth];
  logic [LogDepth-1:0] write_q, read_q;
  logic [LogDepth:0] count_q, count_d;

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
      if (push_i) write_q <= write_q + 1'b1;
      if (pop_i) read_q <= read_q + 1'b1;
      count_q <= count_d;
      valid_o <= count_d != '0;
      space_o <= count_d != (LogDepth + 1)'(Depth);
    end
  end

  always_ff @(posedge clk_i) if (push_i) words[write_q] <= data_i;

  assign data_o = words[read_q];

`ifndef SYNTHESIS
  a_no_overflow :
  assert property (@(posedge clk_i) disable iff (!rst_ni) !(push_i && !space_o));
  a_no_underflow :
  assert property (@(posedge clk_i) disable iff (!rst_ni) !(pop_i && !valid_o));
`endif

endmodule
