// Carry-select adder: {carry_o, sum_o} = a_i + b_i + carry_i.
//
// The operands are cut into groups. Each group computes its sum for both possible carries into it;
// then one multiplexer a group passes the carry on, and each carry selects its group's sum.
// Groups of one width make the paper's uniform adder, groups that grow towards the top its graded
// one (section 3.4).
//
// GroupWidths: see arith_pkg; the widths must add up to Width.
// LookAhead: the groups add by carry look-ahead (1, as the paper's do) or by ripple carry (0).
// Combinational: the delay of the groups, NumGroups - 2 carry multiplexers, one sum multiplexer.
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

  if (arith_pkg::group_low(
      GroupWidths, arith_pkg::MaxGroups
    ) != Width || arith_pkg::group_low(
      GroupWidths, NumGroups
    ) != Width) begin : gen_check
    $error(
      "carry_select_adder: expected GroupWidths that add up to Width, without a 0 between them"
    );
  end

  // Both sums of each group

  logic [Width-1:0] sum_0, sum_1;
  logic [NumGroups-1:0] carry_0, carry_1;

  if (LookAhead) begin : gen_look_ahead
    conditional_sums_look_ahead #(
      .Width      (Width),
      .GroupWidths(GroupWidths)
    ) u_sums (
      .a_i,
      .b_i,
      .carry_i,
      .sum_0_o  (sum_0),
      .sum_1_o  (sum_1),
      .carry_0_o(carry_0),
      .carry_1_o(carry_1)
    );
  end else begin : gen_ripple
    conditional_sums_ripple #(
      .Width      (Width),
      .GroupWidths(GroupWidths)
    ) u_sums (
      .a_i,
      .b_i,
      .carry_i,
      .sum_0_o  (sum_0),
      .sum_1_o  (sum_1),
      .carry_0_o(carry_0),
      .carry_1_o(carry_1)
    );
  end

  // The chain of carries, and the selection of the sums

  logic [Width-1:0] select;

  for (genvar k = 0; k < NumGroups; k++) begin : gen_group
    localparam int unsigned Low = arith_pkg::group_low(GroupWidths, k);
    localparam int unsigned Size = 32'(GroupWidths[8*k+:8]);
    logic carry_in, carry_out;
    if (k == 0) begin : gen_known
      assign carry_in = 1'b0;  // both of its sums count carry_i already
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
