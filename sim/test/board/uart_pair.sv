// A transmitter connected to a receiver by a line that low_i can hold low.
module uart_pair #(
  parameter int unsigned ClocksPerBit = 5
) (
  input  logic        clk_i,
  input  logic        rst_ni,
  input  logic        valid_i,
  output logic        ready_o,
  input  logic [31:0] word_i,
  input  logic        low_i,  // pulls the line low
  output logic        serial_o,
  output logic        valid_o,
  output logic [31:0] word_o,
  output logic        break_o
);

  logic serial;

  assign serial_o = serial & ~low_i;

  uart_transmitter #(
    .ClocksPerBit(ClocksPerBit)
  ) u_transmitter (
    .clk_i,
    .rst_ni,
    .valid_i,
    .ready_o,
    .word_i,
    .serial_o(serial)
  );
  uart_receiver #(
    .ClocksPerBit(ClocksPerBit)
  ) u_receiver (
    .clk_i,
    .rst_ni,
    .serial_i(serial_o),
    .valid_o,
    .word_o,
    .break_o
  );

endmodule
