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

  typedef logic signed [PlaneWidth-1:0] plane_t;

  function automatic plane_t larger(plane_t a, plane_t b);
    larger = (a < b) ? b : a;
  endfunction
  function automatic plane_t smaller(plane_t a, plane_t b);
    smaller = (a < b) ? a : b;
  endfunction

  // ---- Planes

  plane_t near_q[3], far_q[3];

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
      near_q[k] <= near;
      far_q[k]  <= far;
    end
  end

  // ---- Enter: the largest near plane; leave: the smallest far one

  // verilator lint_off UNUSEDSIGNAL
  // An enter within the t_max has no more than UnitBits + 1 bits.
  plane_t enter_q, leave_q;
  // verilator lint_on UNUSEDSIGNAL

  always_ff @(posedge clk_i) begin
    enter_q <= larger(larger(near_q[0], near_q[1]), larger(near_q[2], '0));
    leave_q <= smaller(smaller(far_q[0], far_q[1]), smaller(far_q[2], plane_t'(t_max_i)));
  end

  // ---- The key

  logic entered;
  assign entered = (no_cull_i | (enter_q <= leave_q)) & (kind_i != KindAbsent);

  always_ff @(posedge clk_i) begin
    key_o <= {~entered, (entered & ~no_cull_i) ? enter_q[UnitBits:0] : (UnitBits + 1)'(0)};
  end

endmodule
