// Adder of a chosen kind: {carry_o, sum_o} = a_i + b_i + carry_i. Combinational.
//
// Every addition of significands or exponents uses this module. Arith selects the kind of adder: see arith_pkg.
// GroupWidths and LookAhead configure carry-select adders: see carry_select_adder. Other kinds ignore them. A 0 for
// GroupWidths selects the groups of kind Arith or, with LookAhead and at most 12 bits (an exponent), one group.
module adder #(
  parameter int unsigned Width = 48,
  parameter int unsigned Arith = arith_pkg::Graded,
  parameter bit [8*arith_pkg::MaxGroups-1:0] GroupWidths = '0,
  parameter bit LookAhead = 1'b1
) (
  input  logic [Width-1:0] a_i,
  input  logic [Width-1:0] b_i,
  input  logic             carry_i,
  output logic [Width-1:0] sum_o,
  output logic             carry_o
);

  if (Arith > arith_pkg::Prefix) begin : gen_check
    $error("adder: expected an Arith of arith_pkg::arith_e");
  end

  if (Arith == arith_pkg::Behavioural) begin : gen_behavioural
    assign {carry_o, sum_o} = (Width + 1)'(a_i) + (Width + 1)'(b_i) + (Width + 1)'(carry_i);
  end else if (Arith == arith_pkg::Ripple) begin : gen_ripple
    ripple_carry_adder #(
      .Width(Width)
    ) u_adder (
      .a_i,
      .b_i,
      .carry_i,
      .sum_o,
      .carry_o
    );
  end else if (Arith == arith_pkg::Prefix) begin : gen_prefix
    prefix_adder #(
      .Width(Width)
    ) u_adder (
      .a_i,
      .b_i,
      .carry_i,
      .sum_o,
      .carry_o
    );
  end else begin : gen_select
    localparam int unsigned ListWidth = 8 * arith_pkg::MaxGroups;
    localparam bit [ListWidth-1:0] Uniform = arith_pkg::uniform_groups(Width);
    localparam bit [ListWidth-1:0] Graded = arith_pkg::graded_groups(Width);
    localparam bit [ListWidth-1:0] Groups =
        (GroupWidths != '0) ? GroupWidths : (LookAhead && Width <= 12) ? ListWidth'(Width) :
        (Arith == arith_pkg::Uniform) ? Uniform : Graded;

    carry_select_adder #(
      .Width      (Width),
      .GroupWidths(Groups),
      .LookAhead  (LookAhead)
    ) u_adder (
      .a_i,
      .b_i,
      .carry_i,
      .sum_o,
      .carry_o
    );
  end

endmodule
