// Turns a word declared (* anyseq *), or with CONSTANT (* anyconst *), into a free variable of the proof.
(* techmap_celltype = "$buf" *)
module free_word #(
  parameter WIDTH = 1
) (
  input  [WIDTH-1:0] A,
  output [WIDTH-1:0] Y
);

`ifdef CONSTANT
  \$anyconst #(.WIDTH(WIDTH)) _TECHMAP_REPLACE_ (.Y(Y));
`else
  \$anyseq #(.WIDTH(WIDTH)) _TECHMAP_REPLACE_ (.Y(Y));
`endif

endmodule
