// Sums of each group of a carry-select adder for both carries into it, by carry look-ahead.
//
// All groups are worked on at once, as words: a prefix scan of (generate, propagate) pairs that
// doubles its reach with every step and never looks past the start of a group. A group's carries
// are then "generate" if no carry enters it and "generate or propagate" if one does, so that one
// scan serves both sums. The lowest group knows its carry, which counts as generated.
//
// GroupWidths: see arith_pkg. Bit k of carry_0_o and carry_1_o is the carry out of group k.
// Combinational; ceil(log2(widest group)) steps.
module conditional_sums_look_ahead #(
  parameter int unsigned Width = 48,
  parameter bit [8*arith_pkg::MaxGroups-1:0] GroupWidths = arith_pkg::graded_groups(Width),
  localparam int unsigned NumGroups = arith_pkg::num_groups(GroupWidths)
) (
  input  logic [Width-1:0]     a_i,
  input  logic [Width-1:0]     b_i,
  input  logic                 carry_i,    // into the lowest group
  output logic [Width-1:0]     sum_0_o,    // if no carry enters (in the lowest group: carry_i)
  output logic [Width-1:0]     sum_1_o,    // if a carry enters (in the lowest group: not valid)
  output logic [NumGroups-1:0] carry_0_o,
  output logic [NumGroups-1:0] carry_1_o
);

  localparam int unsigned Widest = arith_pkg::widest_group(GroupWidths);
  localparam logic [Width-1:0] Starts = Width'(arith_pkg::group_starts(GroupWidths));

  logic [Width-1:0] half_sum;   // a bit's sum before its carry: it propagates
  logic [Width-1:0] generated;  // over all bits from the start of the group to this one
  logic [Width-1:0] propagated;

  assign half_sum = a_i ^ b_i;

  always_comb begin : scan
    logic [Width-1:0] near;  // bits from which a step would reach past the start of their group
    generated    = a_i & b_i;
    generated[0] = generated[0] | (half_sum[0] & carry_i);
    propagated   = half_sum;
    near         = Starts;
    for (int unsigned step = 1; step < Widest; step = step * 2) begin
      generated  = generated | (propagated & (generated << step) & ~near);
      propagated = propagated & ((propagated << step) | near);
      near       = near | (near << step);
    end
  end

  assign sum_0_o = half_sum ^ (((generated << 1) & ~Starts) | Width'(carry_i));
  assign sum_1_o = half_sum ^ (((generated | propagated) << 1) | Starts);

  for (genvar k = 0; k < NumGroups; k++) begin : gen_group
    localparam int unsigned High = arith_pkg::group_low(GroupWidths, k + 1) - 1;
    assign carry_0_o[k] = generated[High];
    assign carry_1_o[k] = generated[High] | propagated[High];
  end

endmodule
