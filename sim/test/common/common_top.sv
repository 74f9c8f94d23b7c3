// FIFOs of 2, 4 and 8 words, the same in memories with a clock, a memory, and delay lines of 0 to 5 clocks.
module common_top (
  input  logic         clk_i,
  input  logic         rst_ni,
  input  logic [5:0]   push_i,    // a bit for each FIFO, the one of 2 words lowest, then those in memories
  input  logic [5:0]   pop_i,
  input  logic [31:0]  data_i,    // for all
  output logic [5:0]   space_o,
  output logic [5:0]   valid_o,
  output logic [191:0] word_o,    // 32 bits for each FIFO
  input  logic [3:0]   write_i,   // of the memory of 16 words, with data_i, byte by byte
  input  logic [3:0]   write_address_i,
  input  logic         read_i,
  input  logic [3:0]   read_address_i,
  output logic [31:0]  read_o,
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
    ram_fifo #(
      .Width(32),
      .Depth(2 << n)
    ) u_ram_fifo (
      .clk_i,
      .rst_ni,
      .push_i(push_i[3+n]),
      .data_i,
      .space_o(space_o[3+n]),
      .pop_i(pop_i[3+n]),
      .valid_o(valid_o[3+n]),
      .data_o(word_o[32*(3+n) +: 32])
    );
  end

  ram #(
    .Width(32),
    .Depth(16),
    .Parts(4)
  ) u_ram (
    .clk_i,
    .write_i,
    .write_address_i,
    .data_i,
    .read_i,
    .read_address_i,
    .data_o(read_o)
  );

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
