// Composition of the multiplier's proof, step 5. Claim: a tree of carry-save adders, of which only
// contracts/carry_save_adder.sv is known, adds each row once: sum_o + carry_o = sum of the rows, modulo 2**Width.
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
