// A FIFO's user pushes only into a free place, and pops only with valid_o. valid_o and space_o fit the number of words.
module fifo_checks #(
  parameter int unsigned Depth   = 2,
  parameter int unsigned Reserve = 0,
  parameter bit          Late    = 1'b0  // a word becomes valid one clock later
) (
  input logic clk_i,
  input logic rst_ni,
  input logic push_i,
  input logic space_o,
  input logic pop_i,
  input logic valid_o
);

  localparam int unsigned CountWidth = $clog2(Depth + 1);

  logic [CountWidth-1:0] count_q;
  logic late_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) late_q <= 1'b0;
    else late_q <= Late && push_i;
  end
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) count_q <= '0;
    else count_q <= count_q + CountWidth'(push_i) - CountWidth'(pop_i);
  end

  always_ff @(posedge clk_i) begin
    if (rst_ni) begin
      a_no_overflow : assert (!push_i || count_q != CountWidth'(Depth));
      a_no_underflow : assert (!pop_i || valid_o);
      a_valid : assert (valid_o == (count_q != CountWidth'(late_q)));
      a_space : assert (space_o == (count_q < CountWidth'(Depth - Reserve)));
    end
  end

endmodule
