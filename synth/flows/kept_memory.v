// A memory that is kept: see kept_memories.v.
(* blackbox *)
module kept_memory #(
  parameter BITS = 1,
  parameter READ_ENABLE = 1,
  parameter READ_ADDRESS = 1,
  parameter READ_DATA = 1,
  parameter WRITE_ENABLE = 1,
  parameter WRITE_ADDRESS = 1
) (
  input  [READ_ENABLE-1:0]   read_enable_i,
  input  [READ_ADDRESS-1:0]  read_address_i,
  output [READ_DATA-1:0]     read_data_o,
  input  [WRITE_ENABLE-1:0]  write_enable_i,
  input  [WRITE_ADDRESS-1:0] write_address_i,
  input  [WRITE_ENABLE-1:0]  write_data_i
);
endmodule
