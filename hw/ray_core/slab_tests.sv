// Slab tests of a node's children: the key of each, see slab_test.
// Clocks = 1: a slab_test for each child, a node a clock; latency slab_test's. Else one for all, a child a clock, a node in
// Clocks clocks; latency Children clocks more.
//
// start_i comes with the node, where Clocks is not 1; what else comes, comes as in slab_test.
module slab_tests
  import ray_core_pkg::*;
#(
  parameter int unsigned Clocks = 1,
  parameter int unsigned Arith = arith_pkg::Graded,
  localparam int unsigned KeyWidth = UnitBits + 2
) (
  input  logic                          clk_i,
  input  logic                          start_i,
  input  logic [Children*BoxWidth-1:0]  boxes_i,
  input  logic [2:0]                    back_i,
  input  logic [3*StepWidth-1:0]        step_i,
  input  logic [3*PlaneWidth-1:0]       near_i,
  input  logic [3*PlaneWidth-1:0]       far_i,
  input  logic [2:0]                    next_back_i,
  input  logic [UnitBits:0]             t_max_i,
  input  logic [Children*KindWidth-1:0] kinds_i,
  input  logic                          no_cull_i,
  output logic [Children*KeyWidth-1:0]  keys_o
);

  if (Clocks != 1 && Clocks < Children) begin : gen_check
    $error("slab_tests: expected 1 Clocks, or Children or more");
  end

  // What the tests take: as it comes, or kept for all children
  localparam int unsigned Units = (Clocks == 1) ? Children : 1;
  logic [Children*BoxWidth-1:0] boxes;
  logic [2:0] back, next_back;
  logic [3*StepWidth-1:0] step;
  logic [3*PlaneWidth-1:0] near, far;
  logic [UnitBits:0] t_max;
  logic [Children*KindWidth-1:0] kinds;
  logic no_cull;
  logic [Units*KeyWidth-1:0] keys;

  for (genvar i = 0; i < Units; i++) begin : gen_child
    slab_test #(
      .Arith(Arith)
    ) u_child (
      .clk_i,
      .box_i(boxes[BoxWidth*i +: BoxWidth]),
      .back_i(back),
      .step_i(step),
      .near_i(near),
      .far_i(far),
      .next_back_i(next_back),
      .t_max_i(t_max),
      .kind_i(kinds[KindWidth*i +: KindWidth]),
      .no_cull_i(no_cull),
      .key_o(keys[KeyWidth*i +: KeyWidth])
    );
  end

  if (Clocks == 1) begin : gen_all
    assign {boxes, back, step} = {boxes_i, back_i, step_i};
    assign {near, far, next_back, t_max} = {near_i, far_i, next_back_i, t_max_i};
    assign {kinds, no_cull} = {kinds_i, no_cull_i};
    assign keys_o = keys;

    logic unused_start;
    assign unused_start = start_i;
  end else begin : gen_turns
    logic [3:1] since_q;  // clocks since start_i
    logic [(Children-1)*KeyWidth-1:0] keys_q;  // the latest highest

    always_ff @(posedge clk_i) begin
      since_q <= {since_q[2:1], start_i};
      boxes   <= start_i ? boxes_i : boxes >> BoxWidth;
      if (start_i) {back, step} <= {back_i, step_i};
      if (since_q[1]) {near, far, next_back} <= {near_i, far_i, next_back_i};
      if (since_q[2]) t_max <= t_max_i;
      kinds <= since_q[3] ? kinds_i : kinds >> KindWidth;
      if (since_q[3]) no_cull <= no_cull_i;
      keys_q <= keys_o[Children*KeyWidth-1:KeyWidth];
    end
    assign keys_o = {keys, keys_q};
  end

endmodule
