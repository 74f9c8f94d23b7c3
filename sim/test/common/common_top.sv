// FIFOs of 2, 4 and 8 words, and delay lines of 0 to 5 clocks.
module common_top (
  input  logic         clk_i,
  input  logic         rst_ni,
  input  logic [2:0]   push_i,    // a bit for each FIFO, the one of 2 words lowest
  input  logic [2:0]   pop_i,
  input  logic [31:0]  data_i,    // for all
  output logic [2:0]   space_o,
  output logic [2:0]   valid_o,
  output logic [95:0]  word_o,    // 32 bits for each FIFO
  input  logic         enable_i,  // of the delay lines
  output logic [191:0] delayed_o  // 32 bits for each delay line
);

  for (genvar n = 0; n < 3; n++) begin : gen_fifo
    fifo #(
      .Width(32),
      .Depth(2 << n)
    ) u_fifo (
      .clk_i,
      .rst_ni,
      .push_i(push_i[n]),
      .data_i,
      .space_o(space_o[n]),
      .pop_i(pop_i[n]),
      .valid_o(valid_o[n]),
      .data_o(word_o[32*n +: 32])
    );
  end

  for (genvar n = 0; n < 6; n++) begin : gen_delay_line
    delay_line #(
      .Width(32),
      .Depth(n)
    ) u_delay_line (
      .clk_i,
      .enable_i,
      .data_i,
      .data_o(delayed_o[32*n +: 32])
    );
  end

endmodule
