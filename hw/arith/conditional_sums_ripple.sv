// Sums of each group of a carry-select adder for both carries into it, by two ripple-carry adders a group.
// Combinational; as many full-adder delays as the widest group has bits.
//
// The lowest group knows its carry and needs one adder alone. GroupWidths: see arith_pkg. Bit k of carry_0_o and
// carry_1_o is the carry out of group k.
module conditional_sums_ripple #(
  parameter int unsigned Width = 48,
  parameter bit [8*arith_pkg::MaxGroups-1:0] GroupWidths = arith_pkg::graded_groups(Width),
  localparam int unsigned NumGroups = arith_pkg::num_groups(GroupWidths)
) (
  input  logic [Width-1:0]     a_i,
  input  logic [Width-1:0]     b_i,
  input  logic                 carry_i,    // into the lowest group
  output logic [Width-1:0]     sum_0_o,    // if no carry enters (in the lowest group: carry_i)
  output logic [Width-1:0]     sum_1_o,    // if a carry enters (in the lowest group: as sum_0_o)
  output logic [NumGroups-1:0] carry_0_o,
  output logic [NumGroups-1:0] carry_1_o
);

  for (genvar k = 0; k < NumGroups; k++) begin : gen_group
    localparam int unsigned Low = arith_pkg::group_low(GroupWidths, k);
    localparam int unsigned Size = 32'(GroupWidths[8*k+:8]);

    ripple_carry_adder #(
      .Width(Size)
    ) u_sum_0 (
      .a_i    (a_i[Low +: Size]),
      .b_i    (b_i[Low +: Size]),
      .carry_i((k == 0) ? carry_i : 1'b0),
      .sum_o  (sum_0_o[Low +: Size]),
      .carry_o(carry_0_o[k])
    );

    if (k == 0) begin : gen_known
      assign sum_1_o[Low +: Size] = sum_0_o[Low +: Size];
      assign carry_1_o[k]         = carry_0_o[k];
    end else begin : gen_unknown
      ripple_carry_adder #(
        .Width(Size)
      ) u_sum_1 (
        .a_i    (a_i[Low +: Size]),
        .b_i    (b_i[Low +: Size]),
        .carry_i(1'b1),
        .sum_o  (sum_1_o[Low +: Size]),
        .carry_o(carry_1_o[k])
      );
    end
  end

endmodule
