// Contract of a multiplier: the product is arbitrary here, and is constrained in the query.
module multiplier #(
  parameter int unsigned Width = 24,
  parameter int unsigned Arith = 0,
  parameter bit ConstantRow = 1'b0
) (
  input  logic [Width-1:0]   a_i,
  input  logic [Width-1:0]   b_i,
  output logic [2*Width-1:0] product_o
);
  (* keep *) logic [Width-1:0] free_a, free_b;
  (* anyseq, keep *) logic [2*Width-1:0] free_product;
  assign free_a = a_i;
  assign free_b = b_i;
  assign product_o = free_product;
endmodule
