// Slab set-up: bounds of the plane q = 0, and the step.
// Latency: 1 clock; |a| and s are registered. Units are 2**(E - 22). Formulas: steps 2 to 4 of box_unit's proof.
//
// In:  product_i    a = D / I, binary32, any value
//      inverse_i    1 / |I|, limited to the cap; exponent_i, cap_i: E and the cap's exponent, with binary32's bias
//      is_capped_i  inverse_i is the cap, as 1 / |I| is above it; is_open_i: in addition, binary32 cannot represent it
// Out: planes_o     a - r, lowest, and a + r, two's complement, in units; step_o: s in 256ths of a unit
module slab_setup
  import ray_core_pkg::*;
#(
  parameter int unsigned Arith = arith_pkg::Graded
) (
  input  logic                       clk_i,
  input  logic [31:0]                product_i,
  input  logic [30:0]                inverse_i,
  input  logic [8:0]                 exponent_i,
  input  logic [10:0]                cap_i,
  input  logic                       is_capped_i,
  input  logic                       is_open_i,
  output logic [1:0][PlaneWidth-1:0] planes_o,
  output logic [StepWidth-1:0]       step_o
);

  localparam int unsigned SizeWidth = 34;  // width of |a|, up to 2**33 units
  localparam logic [PlaneWidth-1:0] Far = PlaneWidth'(1) << 33;

  logic [7:0] product_field, inverse_field;
  logic signed [10:0] amount, step_amount;
  logic [SizeWidth-1:0] size_q;
  logic [StepWidth-1:0] step_q;
  logic [PlaneWidth-1:0] a, room;
  logic says_nothing_q, is_negative_q, is_capped_q;

  assign product_field = product_i[23 +: 8];
  assign inverse_field = inverse_i[23 +: 8];
  assign amount        = $signed({2'b0, exponent_i}) + 11'sd11 - $signed({3'b0, product_field});
  assign step_amount   = $signed(cap_i) - $signed({3'b0, inverse_field});
  always_ff @(posedge clk_i) begin
    size_q <= (amount <= 11'sd0) ? SizeWidth'(1) << (SizeWidth - 1)
          : (amount > 11'sd33) ? '0 : {1'b1, product_i[22:0], 10'b0} >> amount[5:0];
    step_q <= (step_amount > 11'sd32) ? '0 : {1'b1, inverse_i[22:0], 9'b0} >> step_amount[5:0];
    says_nothing_q <= is_open_i | (&product_field);
    is_negative_q  <= product_i[31];
    is_capped_q    <= is_capped_i;
  end

  // ---- r: a bound of rounding errors, plus 2**E for a ray that hardly moves along this axis

  logic [11:0] few;
  assign few  = size_q[SizeWidth-1:22] + 12'(step_q[StepWidth-1:24]) + 12'd6;
  assign room = PlaneWidth'(few) | (is_capped_q ? PlaneWidth'(1) << UnitBits : '0);

  // ---- a -+ r

  adder #(
    .Width(PlaneWidth),
    .Arith(Arith)
  ) u_sign (
    .a_i('0),
    .b_i(PlaneWidth'(size_q) ^ {PlaneWidth{is_negative_q}}),
    .carry_i(is_negative_q),
    .sum_o(a),
    .carry_o()
  );
  for (genvar side = 0; side < 2; side++) begin : gen_side
    logic [PlaneWidth-1:0] plane;

    adder #(
      .Width(PlaneWidth),
      .Arith(Arith)
    ) u_plane (
      .a_i(a),
      .b_i((side == 0) ? ~room : room),
      .carry_i((side == 0)),
      .sum_o(plane),
      .carry_o()
    );
    assign planes_o[side] = !says_nothing_q ? plane : (side == 0) ? -Far : Far;
  end
  assign step_o = says_nothing_q ? '0 : step_q;

endmodule
