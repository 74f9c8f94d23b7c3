// Rewrites a > b as b < a, and a <= b as b >= a. Yosys's alumacc would turn them into !(a < b | a == b) and a < b | a
// == b, each with an additional equality.
(* techmap_celltype = "$gt $le" *)
module swapped #(
  parameter A_SIGNED = 0,
  parameter B_SIGNED = 0,
  parameter A_WIDTH = 1,
  parameter B_WIDTH = 1,
  parameter Y_WIDTH = 1
) (
  input  [A_WIDTH-1:0] A,
  input  [B_WIDTH-1:0] B,
  output [Y_WIDTH-1:0] Y
);

  parameter _TECHMAP_CELLTYPE_ = "";

  generate
    if (_TECHMAP_CELLTYPE_ == "$gt")
      \$lt #(.A_SIGNED(B_SIGNED), .B_SIGNED(A_SIGNED), .A_WIDTH(B_WIDTH), .B_WIDTH(A_WIDTH), .Y_WIDTH(Y_WIDTH))
          _TECHMAP_REPLACE_ (.A(B), .B(A), .Y(Y));
    else
      \$ge #(.A_SIGNED(B_SIGNED), .B_SIGNED(A_SIGNED), .A_WIDTH(B_WIDTH), .B_WIDTH(A_WIDTH), .Y_WIDTH(Y_WIDTH))
          _TECHMAP_REPLACE_ (.A(B), .B(A), .Y(Y));
  endgenerate

endmodule
