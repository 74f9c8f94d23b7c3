// Serial line to words of 32 bits: 8N1, four bytes per word, lowest byte and bit first.
//
// Throughput: a word in 40 ClocksPerBit clocks; a bit is sampled in its middle. A low stop bit is a break: break_o is
// high for a clock, and the next byte is the first of a word. word_o is valid only in the clock of valid_o.
module uart_receiver #(
  parameter int unsigned ClocksPerBit = 20
) (
  input  logic        clk_i,
  input  logic        rst_ni,
  input  logic        serial_i,  // from the pin, asynchronous
  output logic        valid_o,
  output logic [31:0] word_o,
  output logic        break_o
);

  if (ClocksPerBit < 4) begin : gen_check
    $error("uart_receiver: expected ClocksPerBit to be 4 or more");
  end

  localparam int unsigned CountWidth = $clog2(ClocksPerBit);

  logic [2:0] serial_q;  // two synchroniser stages, and the level a clock before
  logic [CountWidth-1:0] count_q;
  logic [3:0] bit_q;  // 0: no byte; 1 its start bit, ... 10 its stop bit
  logic [1:0] byte_q;
  logic sample, stop;

  assign sample = (bit_q != '0) & (count_q == '0);
  assign stop   = sample & (bit_q == 4'd10);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      serial_q <= '1;
      count_q  <= '0;
      bit_q    <= '0;
      byte_q   <= '0;
      {valid_o, break_o} <= '0;
    end else begin
      serial_q <= {serial_q[1:0], serial_i};
      valid_o  <= stop & serial_q[1] & (byte_q == 2'd3);
      break_o  <= stop & ~serial_q[1];
      if (bit_q == '0) begin
        count_q <= CountWidth'(ClocksPerBit / 2 - 1);
        if (serial_q[2:1] == 2'b10) bit_q <= 4'd1;
      end else begin
        count_q <= sample ? CountWidth'(ClocksPerBit - 1) : count_q - 1'b1;
        // a false start bit, or the stop bit
        if (stop || (sample && bit_q == 4'd1 && serial_q[1])) bit_q <= '0;
        else if (sample) bit_q <= bit_q + 1'b1;
      end
      if (stop) byte_q <= serial_q[1] ? byte_q + 1'b1 : '0;
    end
  end
  always_ff @(posedge clk_i) begin
    if (sample && bit_q != 4'd1 && !stop) word_o <= {serial_q[1], word_o[31:1]};
  end

endmodule
