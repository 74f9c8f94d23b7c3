// Memory with a clock, one port to write and one to read: what block RAM and SRAM macros are.
//
// The word that is read at a clock edge is at data_o after it and stays there until the next is read. Where one is read
// and written at the same edge, it is the one before. Its contents have no reset.
module ram #(
  parameter int unsigned Width = 32,
  parameter int unsigned Depth = 64,  // at least 2
  localparam int unsigned AddressWidth = (Depth < 2) ? 1 : $clog2(Depth)
) (
  input  logic                    clk_i,
  input  logic                    write_i,
  input  logic [AddressWidth-1:0] write_address_i,
  input  logic [Width-1:0]        data_i,
  input  logic                    read_i,
  input  logic [AddressWidth-1:0] read_address_i,
  output logic [Width-1:0]        data_o
);

  if (Depth < 2) begin : gen_check
    $error("ram: expected a Depth of 2 or more");
  end

  logic [Width-1:0] words[Depth];

  always_ff @(posedge clk_i) begin
    if (write_i) words[write_address_i] <= data_i;
    if (read_i) data_o <= words[read_address_i];
  end

endmodule
