// A FIFO of two words and a delay line, to test the checks of sim/checks and random register contents.
module common_top (
  input  logic        clk_i,
  input  logic        rst_ni,
  input  logic        push_i,
  input  logic        pop_i,
  input  logic [31:0] data_i,
  output logic        space_o,
  output logic        valid_o,
  output logic [31:0] word_o,
  output logic [31:0] delayed_o
);

  fifo #(.Width(32), .Depth(2)) u_fifo (
    .clk_i, .rst_ni, .push_i, .data_i, .space_o, .pop_i, .valid_o, .data_o(word_o));
  delay_line #(.Width(32), .Depth(2)) u_delay_line (
    .clk_i, .enable_i(1'b1), .data_i, .data_o(delayed_o));

endmodule
