// Slab test: whether and where the ray enters the box of one child, from the planes of its three axes, x lowest.
// Latency: 2 clocks, a register behind the planes' offsets and one behind the key.
//
// In:  box_i        low x, y, z, high x, y, z: a byte each; kind_i: ray_core_pkg's
//      back_i       along which axes the ray goes towards smaller q
//      t_max_i      in units; no box is entered beyond it
// Out: key_o        {culled, enter}: enter in units, up to 2**22; 0 where no_cull_i
module slab_test #(
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned StepWidth = ray_core_pkg::StepWidth,
  localparam int unsigned PlaneWidth = ray_core_pkg::PlaneWidth,
  localparam int unsigned UnitBits = ray_core_pkg::UnitBits
) (
  input  logic                               clk_i,
  // in one clock
  input  logic [ray_core_pkg::BoxWidth-1:0]  box_i,
  input  logic [2:0]                         back_i,
  input  logic [3*StepWidth-1:0]             step_i,
  // in the next one
  input  logic [3*PlaneWidth-1:0]            near_i,
  input  logic [3*PlaneWidth-1:0]            far_i,
  input  logic [2:0]                         next_back_i,
  input  logic [UnitBits:0]                  t_max_i,
  input  logic [ray_core_pkg::KindWidth-1:0] kind_i,
  input  logic                               no_cull_i,
  output logic [UnitBits+1:0]                key_o
);

  // ---- Step: q s for both planes of each axis; then the planes

  logic [3*PlaneWidth-1:0] near, far;  // with the sign bit turned, so that they compare as unsigned
  localparam logic [PlaneWidth-1:0] Zero = PlaneWidth'(1) << (PlaneWidth - 1);

  for (genvar k = 0; k < 3; k++) begin : gen_axis
    logic [2*StepWidth-1:0] offsets;  // low, high
    logic [StepWidth-1:0] near_q, far_q;
    logic [PlaneWidth-1:0] near_plane, far_plane;

    for (genvar n = 0; n < 2; n++) begin : gen_offset
      plane_offset #(
        .Width(StepWidth),
        .Arith(Arith),
        .Adder(Adder)
      ) u_offset (
        .q_i(box_i[24*n+8*k +: 8]),
        .step_i(step_i[StepWidth*k +: StepWidth]),
        .offset_o(offsets[StepWidth*n +: StepWidth])
      );
    end
    always_ff @(posedge clk_i) begin
      near_q <= back_i[k] ? offsets[StepWidth +: StepWidth] : offsets[0 +: StepWidth];
      far_q  <= back_i[k] ? offsets[0 +: StepWidth] : offsets[StepWidth +: StepWidth];
    end

    add_subtract #(
      .Width(PlaneWidth),
      .Arith(Arith),
      .Adder(Adder)
    ) u_near (
      .a_i(near_i[PlaneWidth*k +: PlaneWidth]),
      .b_i(PlaneWidth'(near_q)),
      .subtract_i(next_back_i[k]),
      .sum_o(near_plane)
    );
    add_subtract #(
      .Width(PlaneWidth),
      .Arith(Arith),
      .Adder(Adder)
    ) u_far (
      .a_i(far_i[PlaneWidth*k +: PlaneWidth]),
      .b_i(PlaneWidth'(far_q)),
      .subtract_i(next_back_i[k]),
      .sum_o(far_plane)
    );
    assign near[PlaneWidth*k +: PlaneWidth] = near_plane ^ Zero;
    assign far[PlaneWidth*k +: PlaneWidth]  = far_plane ^ Zero;
  end

  // ---- Enter: the largest near plane, the smallest far one

  logic [PlaneWidth-1:0] enter, leave;
  logic left_before, unused_equal;

  max4 #(
    .Width(PlaneWidth),
    .Arith(Arith)
  ) u_enter (
    .words_i({Zero, near}),
    .max_o(enter)
  );
  logic [PlaneWidth-1:0] complement;
  max4 #(
    .Width(PlaneWidth),
    .Arith(Arith)
  ) u_leave (
    .words_i(~{PlaneWidth'(t_max_i) ^ Zero, far}),
    .max_o(complement)
  );
  assign leave = ~complement;

  comparator #(
    .Width(PlaneWidth),
    .Arith(Arith)
  ) u_entered (
    .a_i(leave),
    .b_i(enter),
    .less_o(left_before),
    .equal_o(unused_equal)
  );

  logic entered;
  assign entered = (no_cull_i | ~left_before) & (kind_i != ray_core_pkg::KindAbsent);

  always_ff @(posedge clk_i) begin
    key_o <= {~entered, (entered & ~no_cull_i) ? enter[UnitBits:0] : (UnitBits + 1)'(0)};
  end

  logic unused;  // an enter within the t_max has no more bits
  assign unused = ^enter[PlaneWidth-1:UnitBits+1];

endmodule
