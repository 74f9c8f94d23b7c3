// Carry-select adder: {carry_o, sum_o} = a_i + b_i + carry_i.
//
// The operands are cut into groups. Each group computes its sum for both possible carries into it; then one multiplexer
// per group passes the carry on, and each carry selects its group's sum. Groups of one width make the paper's uniform
// adder, groups that grow towards the top its graded one (section 3.4).
//
// GroupWidths: see arith_pkg; the widths must add up to Width.
// LookAhead: the groups add by carry look-ahead (1, as the paper's do) or by two ripple-carry adders each (0).
// Combinational: the delay of the groups, NumGroups - 2 carry multiplexers, one sum multiplexer. The groups take
// ceil(log2(widest group)) steps, or without LookAhead as many full adders as the widest group has bits.
module carry_select_adder #(
  parameter int unsigned Width = 48,
  parameter bit [8*arith_pkg::MaxGroups-1:0] GroupWidths = arith_pkg::graded_groups(Width),
  parameter bit LookAhead = 1'b1
) (
  input  logic [Width-1:0] a_i,
  input  logic [Width-1:0] b_i,
  input  logic             carry_i,
  output logic [Width-1:0] sum_o,
  output logic             carry_o
);

  localparam int unsigned NumGroups = arith_pkg::num_groups(GroupWidths);
  localparam int unsigned Total = arith_pkg::group_low(GroupWidths, arith_pkg::MaxGroups);

  if (arith_pkg::group_low(GroupWidths, NumGroups) != Width || Total != Width) begin : gen_check
    $error("carry_select_adder: expected GroupWidths that add up to Width, without a 0 between");
  end

  // Both sums of each group, without and with a carry in. The lowest group's carry in is known: carry_i

  logic [Width-1:0] sum_0, sum_1;
  logic [NumGroups-1:0] carry_0, carry_1;

  if (LookAhead) begin : gen_look_ahead
    // All groups are computed at once, as words: a prefix scan of (generate, propagate) pairs that doubles its reach in
    // every step and stops at the start of a group. A group's carries are then "generate" if no carry enters it and
    // "generate or propagate" if one does, so that one scan serves both sums. carry_i counts as generated.
    localparam int unsigned Widest = arith_pkg::widest_group(GroupWidths);
    localparam logic [Width-1:0] Starts = Width'(arith_pkg::group_starts(GroupWidths));

    logic [Width-1:0] half_sum;   // a bit's sum without its carry in; 1: it propagates
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

    assign sum_0 = half_sum ^ (((generated << 1) & ~Starts) | Width'(carry_i));
    assign sum_1 = half_sum ^ (((generated | propagated) << 1) | Starts);

    for (genvar k = 0; k < NumGroups; k++) begin : gen_carries
      localparam int unsigned High = arith_pkg::group_low(GroupWidths, k + 1) - 1;
      assign carry_0[k] = generated[High];
      assign carry_1[k] = generated[High] | propagated[High];
    end
  end else begin : gen_ripple
    for (genvar k = 0; k < NumGroups; k++) begin : gen_sums
      localparam int unsigned Low = arith_pkg::group_low(GroupWidths, k);
      localparam int unsigned Size = 32'(GroupWidths[8*k+:8]);

      ripple_carry_adder #(
        .Width(Size)
      ) u_sum_0 (
        .a_i    (a_i[Low +: Size]),
        .b_i    (b_i[Low +: Size]),
        .carry_i((k == 0) ? carry_i : 1'b0),
        .sum_o  (sum_0[Low +: Size]),
        .carry_o(carry_0[k])
      );
      if (k == 0) begin : gen_known
        assign sum_1[Low +: Size] = sum_0[Low +: Size];
        assign carry_1[k]         = carry_0[k];
      end else begin : gen_unknown
        ripple_carry_adder #(
          .Width(Size)
        ) u_sum_1 (
          .a_i    (a_i[Low +: Size]),
          .b_i    (b_i[Low +: Size]),
          .carry_i(1'b1),
          .sum_o  (sum_1[Low +: Size]),
          .carry_o(carry_1[k])
        );
      end
    end
  end

  // The chain of carries, and the selection of the sums

  logic [Width-1:0] select;

  for (genvar k = 0; k < NumGroups; k++) begin : gen_group
    localparam int unsigned Low = arith_pkg::group_low(GroupWidths, k);
    localparam int unsigned Size = 32'(GroupWidths[8*k+:8]);
    logic carry_in, carry_out;
    if (k == 0) begin : gen_known
      assign carry_in = 1'b0;  // both sums of group 0 include carry_i
    end else begin : gen_unknown
      assign carry_in = gen_group[k-1].carry_out;
    end
    assign select[Low+:Size] = {Size{carry_in}};

    multiplexer #(
      .Ordered(1'b1)
    ) u_carry (
      .select_i(carry_in),
      .when_0_i(carry_0[k]),
      .when_1_i(carry_1[k]),
      .out_o   (carry_out)
    );
  end

  multiplexer #(
    .Width(Width)
  ) u_sum (
    .select_i(select),
    .when_0_i(sum_0),
    .when_1_i(sum_1),
    .out_o   (sum_o)
  );

  assign carry_o = gen_group[NumGroups-1].carry_out;

endmodule
