// Synchronous memory, one write port and one read port: behaves like block RAMs and SRAM macros.
//
// Latency: 1 clock; the word stays at data_o until the next read. Throughput: one read and one write a clock. A word
// read and written at the same edge is read with its old value (read first). The memory has no reset. A word consists
// of `Parts` parts of equal width; bit p of write_i writes part p, part 0 lowest.
module ram #(
  parameter int unsigned Width = 32,  // a multiple of Parts
  parameter int unsigned Depth = 64,
  parameter int unsigned Parts = 1,
  localparam int unsigned AddressWidth = (Depth < 2) ? 1 : $clog2(Depth)
) (
  input  logic                    clk_i,
  input  logic [Parts-1:0]        write_i,
  input  logic [AddressWidth-1:0] write_address_i,
  input  logic [Width-1:0]        data_i,
  input  logic                    read_i,
  input  logic [AddressWidth-1:0] read_address_i,
  output logic [Width-1:0]        data_o
);

  localparam int unsigned PartWidth = Width / Parts;

  if (Depth < 2 || Width % Parts != 0) begin : gen_check
    $error("ram: expected a Depth of 2 or more and a Width of whole Parts");
  end

  logic [Width-1:0] words[Depth];

  always_ff @(posedge clk_i) begin
    for (int unsigned p = 0; p < Parts; p++) begin
      if (write_i[p]) begin
        words[write_address_i][PartWidth*p+:PartWidth] <= data_i[PartWidth*p+:PartWidth];
      end
    end
    if (read_i) data_o <= words[read_address_i];
  end

endmodule
