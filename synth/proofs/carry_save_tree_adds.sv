// Composition, step 5: a tree of adders that keep the promise of contracts/carry_save_adder.sv adds
// up all its rows, each once: sum_o + carry_o = the sum of the rows, modulo 2**Width.
module carry_save_tree_adds #(
  parameter int unsigned Width = 48,
  parameter int unsigned Rows  = 13
) (
  input logic [Width*Rows-1:0] rows
);

  logic [Width-1:0] sum, carry, total;

  carry_save_tree #(
    .Width(Width),
    .Rows (Rows)
  ) dut (
    .rows_i (rows),
    .sum_o  (sum),
    .carry_o(carry)
  );

  always_comb begin
    total = '0;
    for (int unsigned r = 0; r < Rows; r++) total = total + rows[Width*r +: Width];
  end

  always_comb assert (sum + carry == total);

endmodule
