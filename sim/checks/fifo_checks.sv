// A FIFO's user pushes only where there is space and pops only where there is a word; the FIFO counts
// right.
module fifo_checks #(
  parameter int unsigned LogDepth = 1
) (
  input logic clk_i,
  input logic rst_ni,
  input logic push_i,
  input logic space_o,
  input logic pop_i,
  input logic valid_o
);

  logic [LogDepth:0] count_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) count_q <= '0;
    else count_q <= count_q + (LogDepth + 1)'(push_i) - (LogDepth + 1)'(pop_i);
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      a_no_overflow : assert (!push_i || space_o);
      a_no_underflow : assert (!pop_i || valid_o);
      a_valid : assert (valid_o == (count_q != '0));
      a_space : assert (space_o == !count_q[LogDepth]);
    end
  end

endmodule
