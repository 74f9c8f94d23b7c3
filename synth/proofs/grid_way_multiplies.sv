// The way to a plane of a node's grid is q s / 256, cut off: rows and adder give the product. Of steps of 8 bits; a tree is
// that of 33, but for its width.
module grid_way_multiplies #(
  localparam int unsigned Width = 8
) (
  input logic [7:0]       q,
  input logic [Width-1:0] step
);

  logic [Width-1:0] way, expected;

  grid_way #(
    .Width(Width)
  ) dut (
    .q_i(q),
    .step_i(step),
    .way_o(way)
  );
  grid_way #(
    .Width(Width),
    .Arith(arith_pkg::Behavioural)
  ) u_expected (
    .q_i(q),
    .step_i(step),
    .way_o(expected)
  );

  always_comb assert (way == expected);

endmodule
