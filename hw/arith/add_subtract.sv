// Adds or subtracts words, modulo 2**Width: sum_o = a_i + b_i, or a_i - b_i where subtract_i. Combinational.
module add_subtract #(
  parameter int unsigned Width = 36,
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded
) (
  input  logic [Width-1:0] a_i,
  input  logic [Width-1:0] b_i,
  input  logic             subtract_i,
  output logic [Width-1:0] sum_o
);

  logic unused_carry;

  adder #(
    .Width(Width),
    .Arith(Arith),
    .Adder(Adder)
  ) u_adder (
    .a_i,
    .b_i(b_i ^ {Width{subtract_i}}),
    .carry_i(subtract_i),
    .sum_o,
    .carry_o(unused_carry)
  );

endmodule
