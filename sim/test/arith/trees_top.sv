// Carry-save trees of 2 to 16 rows on the same rows.
module trees_top (
  input  logic              clk_i,
  input  logic [48*16-1:0]  rows_i,
  output logic [64*17-1:0]  total_o   // 64 bits for each number of rows; those of 0 and 1 are 0
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

    assign total_o[64*n+:64] = 64'(48'(sum + carry));
  end

endmodule
