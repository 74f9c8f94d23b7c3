// Top of the ULX3S board with an ECP5 85k: board_core, connected to the board's USB serial port and SDRAM.
//
// The PLL makes 40 MHz from the oscillator's 25 MHz. A bit of the serial line takes 20 clocks: 2 Mbaud. Button FIRE1
// resets the core. led[0]: not in reset; led[1]: the serial input is low; led[2]: the serial output is low.
module ulx3s (
  input  wire         clk_25mhz,
  input  wire         btn_fire1,
  input  wire         ftdi_txd,  // the FTDI transmits
  output wire         ftdi_rxd,
  output wire  [2:0]  led,
  output wire         sdram_clk,
  output wire         sdram_cke,
  output wire         sdram_csn,
  output wire         sdram_rasn,
  output wire         sdram_casn,
  output wire         sdram_wen,
  output wire  [12:0] sdram_a,
  output wire  [1:0]  sdram_ba,
  output wire  [1:0]  sdram_dqm,
  inout  wire  [15:0] sdram_d
);

  localparam int unsigned ClockMhz = 40;
  localparam int unsigned ClocksPerBit = 20;

  // ---- Clock: 25 / 5 * 8 * 15 = 600 MHz in the PLL, / 15

  wire clk, locked;

  (* FREQUENCY_PIN_CLKI = "25", FREQUENCY_PIN_CLKOP = "40" *)
  EHXPLLL #(
    .CLKI_DIV(5),
    .CLKFB_DIV(8),
    .CLKOP_DIV(15),
    .CLKOP_CPHASE(7),
    .CLKOP_ENABLE("ENABLED"),
    .FEEDBK_PATH("CLKOP")
  ) u_pll (
    .CLKI(clk_25mhz),
    .CLKFB(clk),
    .CLKOP(clk),
    .LOCK(locked),
    .RST(1'b0),
    .STDBY(1'b0),
    .PHASESEL0(1'b0),
    .PHASESEL1(1'b0),
    .PHASEDIR(1'b0),
    .PHASESTEP(1'b0),
    .PHASELOADREG(1'b0),
    .PLLWAKESYNC(1'b0),
    .ENCLKOP(1'b0)
  );

  // ---- Reset: released synchronously to the clock

  logic [2:0] reset_q;
  wire rst_n;
  wire start_n = locked & ~btn_fire1;

  assign rst_n = reset_q[2];

  always_ff @(posedge clk or negedge start_n) begin
    if (!start_n) reset_q <= '0;
    else reset_q <= {reset_q[1:0], 1'b1};
  end

  // ---- Words over the serial line

  // board_core takes every word at once, because the host sends no more rays than the core has room for.
  logic in_valid, in_break, out_valid, out_ready, unused_ready;
  logic [31:0] in_word, out_word;

  uart_receiver #(
    .ClocksPerBit(ClocksPerBit)
  ) u_receiver (
    .clk_i(clk),
    .rst_ni(rst_n),
    .serial_i(ftdi_txd),
    .valid_o(in_valid),
    .word_o(in_word),
    .break_o(in_break)
  );
  uart_transmitter #(
    .ClocksPerBit(ClocksPerBit)
  ) u_transmitter (
    .clk_i(clk),
    .rst_ni(rst_n),
    .valid_i(out_valid),
    .ready_o(out_ready),
    .word_i(out_word),
    .serial_o(ftdi_rxd)
  );

  // ---- The core, and the SDRAM's pins

  logic drive;
  logic [15:0] data_out, data_in;

  board_core #(
    .ClockMhz(ClockMhz)
  ) u_board (
    .clk_i(clk),
    .rst_ni(rst_n),
    .word_valid_i(in_valid),
    .word_ready_o(unused_ready),
    .word_i(in_word),
    .break_i(in_break),
    .word_valid_o(out_valid),
    .word_ready_i(out_ready),
    .word_o(out_word),
    .sdram_ras_no(sdram_rasn),
    .sdram_cas_no(sdram_casn),
    .sdram_we_no(sdram_wen),
    .sdram_bank_o(sdram_ba),
    .sdram_address_o(sdram_a),
    .sdram_drive_o(drive),
    .sdram_data_o(data_out),
    .sdram_data_i(data_in)
  );

  assign sdram_cke = 1'b1;
  assign sdram_csn = 1'b0;
  assign sdram_dqm = 2'b00;

  // The SDRAM's clock is high in the second half of a clock cycle
  ODDRX1F u_sdram_clk (
    .SCLK(clk),
    .RST(1'b0),
    .D0(1'b0),
    .D1(1'b1),
    .Q(sdram_clk)
  );
  for (genvar i = 0; i < 16; i++) begin : gen_pin
    BB u_pin (
      .I(data_out[i]),
      .T(~drive),
      .O(data_in[i]),
      .B(sdram_d[i])
    );
  end

  assign led = {~ftdi_rxd, ~ftdi_txd, rst_n};

endmodule

// Black boxes of the ECP5 cells used here; Yosys replaces them by its own definitions.
(* blackbox *)
module EHXPLLL #(
  parameter CLKI_DIV = 1,
  parameter CLKFB_DIV = 1,
  parameter CLKOP_DIV = 8,
  parameter CLKOP_CPHASE = 0,
  parameter CLKOP_ENABLE = "ENABLED",
  parameter FEEDBK_PATH = "CLKOP"
) (
  input  CLKI, CLKFB, RST, STDBY, PHASESEL0, PHASESEL1, PHASEDIR, PHASESTEP, PHASELOADREG, PLLWAKESYNC, ENCLKOP,
  output CLKOP, LOCK
);
endmodule

(* blackbox *)
module ODDRX1F (input SCLK, input RST, input D0, input D1, output Q);
endmodule

(* blackbox *)
module BB (input I, input T, output O, inout B);
endmodule
