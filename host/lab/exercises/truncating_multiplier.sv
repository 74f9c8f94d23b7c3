// Multiplier without the lowest Dropped columns of partial products: product_o is at most a_i * b_i, and at
// least a_i * b_i - Width * 2**Dropped. Combinational.
module truncating_multiplier #(
  parameter int unsigned Width = 24,
  parameter int unsigned Dropped = Width + Width / 2 - 2
) (
  input  logic [Width-1:0]   a_i,
  input  logic [Width-1:0]   b_i,
  output logic [2*Width-1:0] product_o
);

  localparam logic [2*Width-1:0] Kept = '1 << Dropped;

  logic [2*Width*Width-1:0] rows;
  logic [2*Width-1:0] sum, carry;
  logic unused_carry;

  for (genvar k = 0; k < Width; k++) begin : gen_row
    logic [Width-1:0] row;
    assign row = a_i & {Width{b_i[k]}};
    assign rows[2*Width*k+:2*Width] = ((2 * Width)'(row) << k) & Kept;
  end

  carry_save_tree #(
    .Width(2 * Width),
    .Rows (Width)
  ) u_tree (
    .rows_i (rows),
    .sum_o  (sum),
    .carry_o(carry)
  );

  adder #(
    .Width(2 * Width)
  ) u_adder (
    .a_i    (sum),
    .b_i    (carry),
    .carry_i(1'b0),
    .sum_o  (product_o),
    .carry_o(unused_carry)
  );

endmodule
