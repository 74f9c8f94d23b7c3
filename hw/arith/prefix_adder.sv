// Parallel-prefix adder after Sklansky: {carry_o, sum_o} = a_i + b_i + carry_i. Any Width from 1.
// Combinational; ceil(log2(Width)) levels, fan-out up to Width / 2.
// Source: J. Sklansky, "Conditional-sum addition logic", IRE Trans. EC-9, 1960.
module prefix_adder #(
  parameter int unsigned Width = 48
) (
  input  logic [Width-1:0] a_i,
  input  logic [Width-1:0] b_i,
  input  logic             carry_i,
  output logic [Width-1:0] sum_o,
  output logic             carry_o
);

  logic [Width-1:0] half_sum;
  logic [Width-1:0] generated;  // by carry_i and the bits from bit 0 to this bit
  logic [Width-1:0] carries;    // carry out of each bit

  assign half_sum = a_i ^ b_i;

  always_comb begin : scan
    logic [Width-1:0] propagated, upper, below_generated, below_propagated;
    generated    = a_i & b_i;
    generated[0] = generated[0] | (half_sum[0] & carry_i);
    propagated   = half_sum;
    // At each level, two blocks of `size` bits merge: generated and propagated at the top of the lower block are copied
    // to all bits of the upper block.
    for (int unsigned size = 1; size < Width; size = size * 2) begin
      for (int unsigned i = 0; i < Width; i++) upper[i] = ((i / size) % 2) == 1;
      below_generated  = (generated << 1) & upper & ~(upper << 1);
      below_propagated = (propagated << 1) & upper & ~(upper << 1);
      for (int unsigned reach = 1; reach < size; reach = reach * 2) begin
        below_generated  = below_generated | (below_generated << reach);
        below_propagated = below_propagated | (below_propagated << reach);
      end
      generated  = generated | (propagated & below_generated);
      propagated = propagated & (below_propagated | ~upper);
    end
    carries = generated;
  end

  assign sum_o   = half_sum ^ ((carries << 1) | Width'(carry_i));
  assign carry_o = carries[Width-1];

endmodule
