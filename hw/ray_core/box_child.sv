// One child of a node: where the ray enters its box, at the latest where it leaves. Two registers: behind the ways
// to the planes, and behind the key. From box_axis' planes and steps of three axes, x lowest.
//
// In:  box_i        low x, y, z, high x, y, z: a byte each; kind_i: ray_core_pkg's
//      back_i       along which axes the ray goes towards smaller q
//      limit_i      in units; no box is entered beyond it
// Out: key_o        {left out, enter}: enter in units, up to 2**22; 0 where every_box_i
module box_child #(
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned StepWidth = ray_core_pkg::StepWidth,
  localparam int unsigned PlaceWidth = ray_core_pkg::PlaceWidth,
  localparam int unsigned UnitBits = ray_core_pkg::UnitBits
) (
  input  logic                               clk_i,
  // in one clock
  input  logic [ray_core_pkg::BoxWidth-1:0]  box_i,
  input  logic [2:0]                         back_i,
  input  logic [3*StepWidth-1:0]             step_i,
  // in the next one
  input  logic [3*PlaceWidth-1:0]            near_i,
  input  logic [3*PlaceWidth-1:0]            far_i,
  input  logic [2:0]                         next_back_i,
  input  logic [UnitBits:0]                  limit_i,
  input  logic [ray_core_pkg::KindWidth-1:0] kind_i,
  input  logic                               every_box_i,
  output logic [UnitBits+1:0]                key_o
);

  // ---- Step: q s for both planes of each axis; then the planes

  logic [3*PlaceWidth-1:0] near, far;  // with the sign bit turned, so that they compare as unsigned
  localparam logic [PlaceWidth-1:0] Zero = PlaceWidth'(1) << (PlaceWidth - 1);

  for (genvar k = 0; k < 3; k++) begin : gen_axis
    logic [2*StepWidth-1:0] ways;  // low, high
    logic [StepWidth-1:0] near_q, far_q;
    logic [PlaceWidth-1:0] near_place, far_place;

    for (genvar n = 0; n < 2; n++) begin : gen_way
      grid_way #(
        .Width(StepWidth),
        .Arith(Arith),
        .Adder(Adder)
      ) u_way (
        .q_i(box_i[24*n+8*k +: 8]),
        .step_i(step_i[StepWidth*k +: StepWidth]),
        .way_o(ways[StepWidth*n +: StepWidth])
      );
    end
    always_ff @(posedge clk_i) begin
      near_q <= back_i[k] ? ways[StepWidth +: StepWidth] : ways[0 +: StepWidth];
      far_q  <= back_i[k] ? ways[0 +: StepWidth] : ways[StepWidth +: StepWidth];
    end

    add_subtract #(
      .Width(PlaceWidth),
      .Arith(Arith),
      .Adder(Adder)
    ) u_near (
      .a_i(near_i[PlaceWidth*k +: PlaceWidth]),
      .b_i(PlaceWidth'(near_q)),
      .subtract_i(next_back_i[k]),
      .sum_o(near_place)
    );
    add_subtract #(
      .Width(PlaceWidth),
      .Arith(Arith),
      .Adder(Adder)
    ) u_far (
      .a_i(far_i[PlaceWidth*k +: PlaceWidth]),
      .b_i(PlaceWidth'(far_q)),
      .subtract_i(next_back_i[k]),
      .sum_o(far_place)
    );
    assign near[PlaceWidth*k +: PlaceWidth] = near_place ^ Zero;
    assign far[PlaceWidth*k +: PlaceWidth]  = far_place ^ Zero;
  end

  // ---- Enter: the largest near plane, the smallest far one

  logic [PlaceWidth-1:0] enter, leave;
  logic left_before, unused_equal;

  largest #(
    .Width(PlaceWidth),
    .Arith(Arith)
  ) u_enter (
    .words_i({Zero, near}),
    .largest_o(enter)
  );
  logic [PlaceWidth-1:0] complement;
  largest #(
    .Width(PlaceWidth),
    .Arith(Arith)
  ) u_leave (
    .words_i(~{PlaceWidth'(limit_i) ^ Zero, far}),
    .largest_o(complement)
  );
  assign leave = ~complement;

  comparator #(
    .Width(PlaceWidth),
    .Arith(Arith)
  ) u_entered (
    .a_i(leave),
    .b_i(enter),
    .less_o(left_before),
    .equal_o(unused_equal)
  );

  logic entered;
  assign entered = (every_box_i | ~left_before) & (kind_i != ray_core_pkg::KindAbsent);

  always_ff @(posedge clk_i) begin
    key_o <= {~entered, (entered & ~every_box_i) ? enter[UnitBits:0] : (UnitBits + 1)'(0)};
  end

  logic unused;  // an enter within the limit has no more bits
  assign unused = ^enter[PlaceWidth-1:UnitBits+1];

endmodule
