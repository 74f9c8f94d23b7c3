// Arrays of more than 2,048 bits are kept as memories, including the registers at their read ports. The memory's ports
// become ports of the design, because there is no SRAM to map to. Smaller arrays become registers, and read-only tables
// become gates. Each bit of a port is a black-box cell of one bit, because Yosys's `expose -evert` gives ports the
// default width of the black box. Write enables: see kept_enables.v.
(* techmap_celltype = "$mem_v2" *)
module keep_large_memory #(
  parameter MEMID = "",
  parameter SIZE = 0,
  parameter OFFSET = 0,
  parameter ABITS = 0,
  parameter WIDTH = 0,
  parameter INIT = 0,
  parameter RD_PORTS = 0,
  parameter RD_CLK_ENABLE = 0,
  parameter RD_CLK_POLARITY = 0,
  parameter RD_TRANSPARENCY_MASK = 0,
  parameter RD_COLLISION_X_MASK = 0,
  parameter RD_WIDE_CONTINUATION = 0,
  parameter RD_CE_OVER_SRST = 0,
  parameter RD_ARST_VALUE = 0,
  parameter RD_SRST_VALUE = 0,
  parameter RD_INIT_VALUE = 0,
  parameter WR_PORTS = 0,
  parameter WR_CLK_ENABLE = 0,
  parameter WR_CLK_POLARITY = 0,
  parameter WR_PRIORITY_MASK = 0,
  parameter WR_WIDE_CONTINUATION = 0
) (
  input  [RD_PORTS-1:0]       RD_CLK,
  input  [RD_PORTS-1:0]       RD_EN,
  input  [RD_PORTS-1:0]       RD_ARST,
  input  [RD_PORTS-1:0]       RD_SRST,
  input  [RD_PORTS*ABITS-1:0] RD_ADDR,
  output [RD_PORTS*WIDTH-1:0] RD_DATA,
  input  [WR_PORTS-1:0]       WR_CLK,
  input  [WR_PORTS*WIDTH-1:0] WR_EN,
  input  [WR_PORTS*ABITS-1:0] WR_ADDR,
  input  [WR_PORTS*WIDTH-1:0] WR_DATA
);

  wire _TECHMAP_FAIL_ = SIZE * WIDTH <= 2048 || WR_PORTS == 0;

  kept_memory #(
    .BITS(SIZE * WIDTH)
  ) _TECHMAP_REPLACE_ ();

  genvar i;
  generate
    if (1) begin : _TECHMAP_REPLACE_
      for (i = 0; i < RD_PORTS; i = i + 1) begin : read_enable_i
        kept_input u_bit (.bit_i(RD_EN[i]));
      end
      for (i = 0; i < RD_PORTS * ABITS; i = i + 1) begin : read_address_i
        kept_input u_bit (.bit_i(RD_ADDR[i]));
      end
      for (i = 0; i < RD_PORTS * WIDTH; i = i + 1) begin : read_data_o
        kept_output u_bit (.bit_o(RD_DATA[i]));
      end
      kept_enables #(.WIDTH(WR_PORTS * WIDTH)) write_enable_i (.bits_i(WR_EN));
      for (i = 0; i < WR_PORTS * ABITS; i = i + 1) begin : write_address_i
        kept_input u_bit (.bit_i(WR_ADDR[i]));
      end
      for (i = 0; i < WR_PORTS * WIDTH; i = i + 1) begin : write_data_i
        kept_input u_bit (.bit_i(WR_DATA[i]));
      end
    end
  endgenerate

endmodule
