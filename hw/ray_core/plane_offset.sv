// Offset of a plane in a node's grid: offset_o = floor(q s / 256), for q of eight bits. Combinational.
//
// Structural is a carry-save tree of s shifted, a row for each bit of q, and an adder; Behavioural is `*`.
module plane_offset #(
  parameter int unsigned Width = 33,  // of s
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded
) (
  input  logic [7:0]       q_i,
  input  logic [Width-1:0] step_i,
  output logic [Width-1:0] offset_o
);

  logic [Width+7:0] product;

  if (Arith == arith_pkg::Behavioural) begin : gen_behavioural
    assign product = (Width + 8)'(q_i) * (Width + 8)'(step_i);
  end else begin : gen_rows
    logic [8*(Width+8)-1:0] rows;
    logic [Width+7:0] sum, carry;
    logic unused_carry;  // the product has Width + 8 bits

    for (genvar b = 0; b < 8; b++) begin : gen_row
      assign rows[(Width+8)*b+:Width+8] = q_i[b] ? (Width + 8)'(step_i) << b : '0;
    end
    carry_save_tree #(
      .Width(Width + 8),
      .Rows(8)
    ) u_tree (
      .rows_i(rows),
      .sum_o(sum),
      .carry_o(carry)
    );
    adder #(
      .Width(Width + 8),
      .Adder(Adder)
    ) u_adder (
      .a_i(sum),
      .b_i(carry),
      .carry_i(1'b0),
      .sum_o(product),
      .carry_o(unused_carry)
    );
  end

  assign offset_o = product[Width+7:8];

  logic unused;  // fractions of a unit
  assign unused = ^product[7:0];

endmodule
