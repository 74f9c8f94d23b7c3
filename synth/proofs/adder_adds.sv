// Claim: {carry_o, sum_o} = a_i + b_i + carry_i for all operands.
module adder_adds #(
  parameter int unsigned Width = 48,
  parameter int unsigned Arith = arith_pkg::Graded,
  parameter bit [8*arith_pkg::MaxGroups-1:0] GroupWidths = '0,
  parameter bit LookAhead = 1'b1
) (
  input  logic [Width-1:0] a,
  input  logic [Width-1:0] b,
  input  logic             carry,
  output logic [Width-1:0] sum,
  output logic             carry_out
);

  adder #(
    .Width      (Width),
    .Arith      (Arith),
    .GroupWidths(GroupWidths),
    .LookAhead  (LookAhead)
  ) dut (
    .a_i    (a),
    .b_i    (b),
    .carry_i(carry),
    .sum_o  (sum),
    .carry_o(carry_out)
  );

  always_comb assert ({carry_out, sum} == (Width + 1)'(a) + (Width + 1)'(b) + (Width + 1)'(carry));

endmodule
