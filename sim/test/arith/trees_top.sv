// Carry-save trees of 2 to 16 rows on the same rows, and the shape of the tree of 14.
module trees_top (
  input  logic              clk_i,
  input  logic [48*16-1:0]  rows_i,
  output logic [64*17-1:0]  total_o,       // 64 bits for each number of rows; those of 0 and 1 are 0
  output logic [8*8-1:0]    rows_of_14_o,  // rows after level k in byte k
  output logic [7:0]        levels_of_14_o
);

  logic [48*16-1:0] rows;

  always_ff @(posedge clk_i) rows <= rows_i;

  assign total_o[127:0] = '0;

  for (genvar n = 2; n <= 16; n++) begin : gen_tree
    logic [47:0] sum, carry;

    carry_save_tree #(
      .Width(48),
      .Rows (n)
    ) u_tree (
      .rows_i (rows[48*n-1:0]),
      .sum_o  (sum),
      .carry_o(carry)
    );

    assign total_o[64*n +: 64] = 64'(48'(sum + carry));
  end

  for (genvar l = 0; l < 8; l++) begin : gen_level
    assign rows_of_14_o[8*l +: 8] = 8'(arith_pkg::tree_rows(14, l));
  end
  assign levels_of_14_o = 8'(arith_pkg::tree_levels(14));

endmodule
