// The offset to a plane of a node's grid is q s / 256, cut off: rows and adder give the product. Of steps of 8 bits; a tree is
// that of 33, but for its width.
module plane_offset_multiplies #(
  localparam int unsigned Width = 8
) (
  input logic [7:0]       q,
  input logic [Width-1:0] step
);

  logic [Width-1:0] offset, expected;

  plane_offset #(
    .Width(Width)
  ) dut (
    .q_i(q),
    .step_i(step),
    .offset_o(offset)
  );
  plane_offset #(
    .Width(Width),
    .Arith(arith_pkg::Behavioural)
  ) u_expected (
    .q_i(q),
    .step_i(step),
    .offset_o(expected)
  );

  always_comb assert (offset == expected);

endmodule
