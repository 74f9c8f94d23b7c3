// Slab test: whether and where the ray enters the box of one child, from the planes of its three axes, x lowest.
// Latency: 4 clocks, a register behind products, planes, the largest and smallest of them, and the key.
//
// In:  box_i        low x, y, z, high x, y, z: a byte each; step_i: s; back_i: along which axes the ray goes towards
//                   smaller q
//      near_i, far_i, next_back_i  in the next clock
//      t_max_i      in units, two clocks later; no box is entered beyond it
//      kind_i       ray_core_pkg's, three clocks later; no_cull_i, too
// Out: key_o        {culled, enter}: enter in units, up to 2**22; 0 where no_cull_i
module slab_test
  import ray_core_pkg::*;
#(
  parameter int unsigned Arith = arith_pkg::Graded
) (
  input  logic                    clk_i,
  input  logic [BoxWidth-1:0]     box_i,
  input  logic [2:0]              back_i,
  input  logic [3*StepWidth-1:0]  step_i,
  input  logic [3*PlaneWidth-1:0] near_i,
  input  logic [3*PlaneWidth-1:0] far_i,
  input  logic [2:0]              next_back_i,
  input  logic [UnitBits:0]       t_max_i,
  input  logic [KindWidth-1:0]    kind_i,
  input  logic                    no_cull_i,
  output logic [UnitBits+1:0]     key_o
);

  // ---- Planes, with the sign bit turned, so that they compare as unsigned

  logic [3*PlaneWidth-1:0] near_q, far_q;
  localparam logic [PlaneWidth-1:0] Zero = PlaneWidth'(1) << (PlaneWidth - 1);

  for (genvar k = 0; k < 3; k++) begin : gen_axis
    logic [PlaneWidth-1:0] near, far;

    plane_offset #(
      .Width(StepWidth),
      .PlaneWidth(PlaneWidth),
      .Arith(Arith)
    ) u_near (
      .clk_i,
      .q_i(back_i[k] ? box_i[24+8*k +: 8] : box_i[8*k +: 8]),
      .step_i(step_i[StepWidth*k +: StepWidth]),
      .from_i(near_i[PlaneWidth*k +: PlaneWidth]),
      .back_i(next_back_i[k]),
      .plane_o(near)
    );
    plane_offset #(
      .Width(StepWidth),
      .PlaneWidth(PlaneWidth),
      .Arith(Arith)
    ) u_far (
      .clk_i,
      .q_i(back_i[k] ? box_i[8*k +: 8] : box_i[24+8*k +: 8]),
      .step_i(step_i[StepWidth*k +: StepWidth]),
      .from_i(far_i[PlaneWidth*k +: PlaneWidth]),
      .back_i(next_back_i[k]),
      .plane_o(far)
    );
    always_ff @(posedge clk_i) begin
      near_q[PlaneWidth*k +: PlaneWidth] <= near ^ Zero;
      far_q[PlaneWidth*k +: PlaneWidth]  <= far ^ Zero;
    end
  end

  // ---- Enter: the largest near plane; leave: the smallest far one

  logic [PlaneWidth-1:0] enter, enter_q, complement, leave_q;
  logic left_before;

  max4 #(
    .Width(PlaneWidth),
    .Arith(Arith)
  ) u_enter (
    .words_i({Zero, near_q}),
    .max_o(enter)
  );
  max4 #(
    .Width(PlaneWidth),
    .Arith(Arith)
  ) u_leave (
    .words_i(~{PlaneWidth'(t_max_i) ^ Zero, far_q}),
    .max_o(complement)
  );
  always_ff @(posedge clk_i) begin
    enter_q <= enter;
    leave_q <= ~complement;
  end

  // ---- The key

  comparator #(
    .Width(PlaneWidth),
    .Arith(Arith)
  ) u_entered (
    .a_i(leave_q),
    .b_i(enter_q),
    .less_o(left_before),
    .equal_o()
  );

  logic entered;
  assign entered = (no_cull_i | ~left_before) & (kind_i != KindAbsent);

  always_ff @(posedge clk_i) begin
    key_o <= {~entered, (entered & ~no_cull_i) ? enter_q[UnitBits:0] : (UnitBits + 1)'(0)};
  end

  logic unused;  // an enter within the t_max has no more bits
  assign unused = ^enter_q[PlaneWidth-1:UnitBits+1];

endmodule
