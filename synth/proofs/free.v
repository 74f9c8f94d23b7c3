// A word that is declared (* anyseq *), and with CONSTANT one that is (* anyconst *): free, where Yosys's reader has it unknown.
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
