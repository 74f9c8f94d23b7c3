// Words of 32 bits to a serial line: 8N1, four bytes per word, lowest byte and bit first; valid/ready.
// Throughput: a word in 40 ClocksPerBit clocks.
module uart_transmitter #(
  parameter int unsigned ClocksPerBit = 20
) (
  input  logic        clk_i,
  input  logic        rst_ni,
  input  logic        valid_i,
  output logic        ready_o,
  input  logic [31:0] word_i,
  output logic        serial_o
);

  localparam int unsigned CountWidth = $clog2(ClocksPerBit);
  localparam int unsigned Bits = 40;

  if (ClocksPerBit < 2) begin : gen_check
    $error("uart_transmitter: expected ClocksPerBit to be 2 or more");
  end

  logic [Bits-1:0] bits_q;  // lowest: the bit on the line; ones follow the last bit
  logic [$clog2(Bits+1)-1:0] left_q;
  logic [CountWidth-1:0] count_q;

  assign ready_o  = left_q == '0;
  assign serial_o = bits_q[0];

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      bits_q  <= '1;
      left_q  <= '0;
      count_q <= '0;
    end else if (ready_o) begin
      count_q <= CountWidth'(ClocksPerBit - 1);
      if (valid_i) begin
        left_q <= ($clog2(Bits + 1))'(Bits);
        bits_q <= {1'b1, word_i[31:24], 2'b01, word_i[23:16], 2'b01, word_i[15:8], 2'b01,
                   word_i[7:0], 1'b0};
      end
    end else begin
      count_q <= (count_q == '0) ? CountWidth'(ClocksPerBit - 1) : count_q - 1'b1;
      if (count_q == '0) begin
        bits_q <= {1'b1, bits_q[Bits-1:1]};
        left_q <= left_q - 1'b1;
      end
    end
  end

endmodule
