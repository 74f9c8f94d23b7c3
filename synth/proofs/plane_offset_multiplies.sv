// Claim: plane_offset computes the same plane with a carry-save tree and an adder as with `*`: from + floor(q step /
// 256), or from - floor(q step / 256). Proven for steps of few bits; for steps of 33 bits, only widths differ.
module plane_offset_multiplies #(
  parameter int unsigned Width = 8,
  parameter int unsigned PlaneWidth = 11
) (
  input logic                  clk,
  input logic [7:0]            q,
  input logic [Width-1:0]      step,
  input logic [PlaneWidth-1:0] from,
  input logic                  back
);

  logic full;  // at least one clock has passed
  initial full = 1'b0;
  always_ff @(posedge clk) full <= 1'b1;

  logic [PlaneWidth-1:0] plane, expected;

  plane_offset #(
    .Width(Width),
    .PlaneWidth(PlaneWidth)
  ) dut (
    .clk_i(clk),
    .q_i(q),
    .step_i(step),
    .from_i(from),
    .back_i(back),
    .plane_o(plane)
  );
  plane_offset #(
    .Width(Width),
    .PlaneWidth(PlaneWidth),
    .Arith(arith_pkg::Behavioural)
  ) u_expected (
    .clk_i(clk),
    .q_i(q),
    .step_i(step),
    .from_i(from),
    .back_i(back),
    .plane_o(expected)
  );

  always_comb if (full) assert (plane == expected);

endmodule
