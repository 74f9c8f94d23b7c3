// Slab test: whether and where the ray enters one child's box. Vectors have x lowest.
// Latency: 4 clocks: registers after products, planes, the largest and smallest of them, and the key.
//
// In:  box_i         low x, y, z, high x, y, z: a byte each; step_i: s; back_i: 1 for each axis along which the ray
//                    goes towards smaller q
//      next_planes_i, next_back_i  a clock later: the planes at q = 0, near ones and far ones; and back_i again
//      t_max_i       in units, two clocks later: no box is entered beyond this t
//      kind_i        the child's kind (ray_core_pkg), three clocks later
// Out: key_o         {not entered, enter}: enter is a lower bound of the t of entry, in units, up to 2**22
module slab_test
  import ray_core_pkg::*;
#(
  parameter int unsigned Arith = arith_pkg::Graded
) (
  input  logic                            clk_i,
  input  logic [BoxWidth-1:0]             box_i,
  input  logic [2:0]                      back_i,
  input  logic [3*StepWidth-1:0]          step_i,
  input  logic [1:0][2:0][PlaneWidth-1:0] next_planes_i,
  input  logic [2:0]                      next_back_i,
  input  logic [UnitBits:0]               t_max_i,
  input  logic [KindWidth-1:0]            kind_i,
  output logic [UnitBits+1:0]             key_o
);

  typedef logic signed [PlaneWidth-1:0] plane_t;

  function automatic plane_t larger(plane_t a, plane_t b);
    larger = (a < b) ? b : a;
  endfunction
  function automatic plane_t smaller(plane_t a, plane_t b);
    smaller = (a < b) ? a : b;
  endfunction

  // ---- Planes: near, far

  plane_t planes_q[2][3];

  for (genvar side = 0; side < 2; side++) begin : gen_side
    for (genvar k = 0; k < 3; k++) begin : gen_axis
      logic is_high;
      logic [PlaneWidth-1:0] plane;
      assign is_high = (side == 1) ^ back_i[k];

      plane_offset #(
        .Width(StepWidth),
        .PlaneWidth(PlaneWidth),
        .Arith(Arith)
      ) u_plane (
        .clk_i,
        .q_i(is_high ? box_i[24+8*k +: 8] : box_i[8*k +: 8]),
        .step_i(step_i[StepWidth*k +: StepWidth]),
        .from_i(next_planes_i[side][k]),
        .back_i(next_back_i[k]),
        .plane_o(plane)
      );
      always_ff @(posedge clk_i) planes_q[side][k] <= plane;
    end
  end

  // ---- Enter: the largest near plane; leave: the smallest far one

  // verilator lint_off UNUSEDSIGNAL
  // Only an enter_q of at most t_max is used, which has no more than UnitBits + 1 bits.
  plane_t enter_q, leave_q;
  // verilator lint_on UNUSEDSIGNAL

  always_ff @(posedge clk_i) begin
    enter_q <= larger(larger(planes_q[0][0], planes_q[0][1]), larger(planes_q[0][2], '0));
    leave_q <= smaller(smaller(planes_q[1][0], planes_q[1][1]),
                       smaller(planes_q[1][2], plane_t'(t_max_i)));
  end

  // ---- The key

  logic entered;
  assign entered = (enter_q <= leave_q) & (kind_i != KindAbsent);

  always_ff @(posedge clk_i) key_o <= {~entered, entered ? enter_q[UnitBits:0] : '0};

endmodule
