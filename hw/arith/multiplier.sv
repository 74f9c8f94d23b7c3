// Unsigned multiplier of a chosen kind: product_o = a_i * b_i. Combinational; any Width from 2.
//
// Arith: Behavioural uses `*`; all other kinds use booth_multiplier. ConstantRow: see booth_multiplier.
module multiplier #(
  parameter int unsigned Width = 24,
  parameter int unsigned Arith = arith_pkg::Graded,
  parameter bit ConstantRow = 1'b0
) (
  input  logic [Width-1:0]   a_i,
  input  logic [Width-1:0]   b_i,
  output logic [2*Width-1:0] product_o
);

  if (Width < 2 || Arith > arith_pkg::Prefix) begin : gen_check
    $error("multiplier: expected a Width of 2 or more and an Arith of arith_pkg::arith_e");
  end else if (Arith == arith_pkg::Behavioural) begin : gen_behavioural
    assign product_o = (2 * Width)'(a_i) * (2 * Width)'(b_i);
  end else begin : gen_booth
    booth_multiplier #(
      .Width(Width),
      .Arith(Arith),
      .ConstantRow(ConstantRow)
    ) u_multiplier (
      .a_i,
      .b_i,
      .product_o
    );
  end

endmodule
