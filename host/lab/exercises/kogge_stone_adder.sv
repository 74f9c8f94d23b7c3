// Parallel-prefix adder after Kogge and Stone: {carry_o, sum_o} = a_i + b_i + carry_i. Combinational; any Width from 1;
// ceil(log2(Width)) levels. Every fan-out is small, at the cost of wires.
// Source: P. M. Kogge and H. S. Stone, "A parallel algorithm for the efficient solution of a general class of recurrence
// equations", IEEE Trans. C-22, 1973.
module kogge_stone_adder #(
  parameter int unsigned Width = 48
) (
  input  logic [Width-1:0] a_i,
  input  logic [Width-1:0] b_i,
  input  logic             carry_i,
  output logic [Width-1:0] sum_o,
  output logic             carry_o
);

  logic [Width-1:0] half_sum, carries;  // carries: out of each bit

  assign half_sum = a_i ^ b_i;

  always_comb begin : scan
    logic [Width-1:0] generated, propagated;  // over the `reach` bits that end at this bit
    generated    = a_i & b_i;
    generated[0] = generated[0] | (half_sum[0] & carry_i);
    propagated   = half_sum;
    for (int unsigned reach = 1; reach < Width; reach = reach * 2) begin
      generated  = generated | (propagated & (generated << reach));
      propagated = propagated & (propagated << reach);
    end
    carries = generated;
  end

  assign sum_o   = half_sum ^ ((carries << 1) | Width'(carry_i));
  assign carry_o = carries[Width-1];

endmodule
