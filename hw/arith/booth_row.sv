// Partial product of a radix-4 Booth multiplier, without its sign. Combinational.
// digit * a_i = row_o + negative_i - negative_i * 2**(Width+1). For a negative digit, row_o is the complement of the
// multiple, without the +1 of two's complement and without sign extension.
module booth_row #(
  parameter int unsigned Width = 24
) (
  input  logic [Width-1:0] a_i,
  input  logic             one_i,       // the digit is 1 or -1
  input  logic             two_i,       // the digit is 2 or -2
  input  logic             negative_i,
  output logic [Width:0]   row_o
);

  logic [Width:0] once, twice;

  assign once  = {1'b0, a_i} & {(Width + 1){one_i}};
  assign twice = {a_i, 1'b0} & {(Width + 1){two_i}};
  assign row_o = (once | twice) ^ {(Width + 1){negative_i}};

endmodule
