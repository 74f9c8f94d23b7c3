// The largest of four unsigned words. Combinational, two comparators deep.
module max4 #(
  parameter int unsigned Width = 36,
  parameter int unsigned Arith = arith_pkg::Graded
) (
  input  logic [4*Width-1:0] words_i,
  output logic [Width-1:0]   max_o
);

  for (genvar n = 0; n < 2; n++) begin : gen_pair
    logic [Width-1:0] a, b, larger;
    logic less;
    assign a = words_i[2*Width*n +: Width];
    assign b = words_i[2*Width*n+Width +: Width];

    comparator #(
      .Width(Width),
      .Arith(Arith)
    ) u_comparator (
      .a_i(a),
      .b_i(b),
      .less_o(less),
      .equal_o()
    );
    assign larger = less ? b : a;
  end

  logic last_less;

  comparator #(
    .Width(Width),
    .Arith(Arith)
  ) u_last (
    .a_i(gen_pair[0].larger),
    .b_i(gen_pair[1].larger),
    .less_o(last_less),
    .equal_o()
  );
  assign max_o = last_less ? gen_pair[1].larger : gen_pair[0].larger;

endmodule
