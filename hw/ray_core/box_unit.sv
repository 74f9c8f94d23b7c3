// Box test: which children of a node a ray enters, near first.
// Latency: 21 clocks (BoxLatency). Throughput: a node line and a ray in Clocks clocks.
//
//   take        the node, a clock later the ray's words                     registers
//   subtract    D_k = origin_k - O_k                                        3 adders
//   scale       2**E, a bound of t in this node; caps of 1 / I_k            see ray_scale
//   multiply    a_k = D_k / I_k                                             3 multipliers
//   align       a_k and the grid's step s_k in units of 2**(E - 22),        see slab_setup
//               bound r_k of their errors
//   step        a_k -+ r_k +- q s_k for the planes of all boxes             42 products, 8 x 33, see plane_offset
//   enter       largest near plane, smallest far plane                      49 comparisons, see slab_test
//   sort        near first; the group                                       see child_sort, sort7
//
// If Clocks is not 1, one child is stepped and entered in each clock, and the latency is Children clocks more. The
// ray's words come from a memory: a clock after ctx_i and node_i.
//
// In:  ctx_i        the ray's context; node_i: its node, see ray_core_pkg; a node with an error has no children
//      origin_i     O, binary32; word x lowest, here and below
//      inverse_i    1 / I_k, rounded to nearest (infinite where I_k is zero); the largest I_k is in [1, 2)
//      t_max_i      no hits beyond it are wanted: a positive binary32 number without its sign, or infinity
// Out: ctx_o, boxes_o  see ray_core_pkg; an entry of the group that is in neither mask, inner or leaf, is invalid
//
// Claim: if the ray has a point O + t I with 0 < t <= t_max in a box, in exact arithmetic, the box is entered. Proof,
// with u = 2**-24 and without the bias in e_k:
//
//  1. Bound of t. In the box, t is at most t_max and, for each k, at most (|origin_k - O_k| + 255 * 2**e_k) / |I_k|.
//     Let 2**M be above the computed |D_k| and above 2**(e_k + 8). Then the dividend is below 2**(M + 1), and the
//     quotient below 2**(M + exponent(1 / I_k) + 2). E is the least of these three exponents and exponent(t_max) + 1,
//     so t < 2**E. E is raised to at least -100, so that underflow changes less than a unit.
//  2. Error of planes. The ray meets a plane of the grid at t = (D_k + q 2**e_k) / I_k = a_k +- q s_k, with
//     s_k = 2**e_k / |I_k|. a_k is off by three roundings, 3.01 u |a_k|, and 1 unit by truncation. q s_k is off by one
//     rounding, u q s_k, and 2 units by two truncations. r_k = 4 u |a_k| + 256 u s_k + 6 units is more, though its
//     first two terms are truncated.
//  3. If s_k is above the cap, 2**(E + 2), the ray moves less than a quarter of a cell along k while t < 2**E. It is
//     replaced by a ray whose s_k is the cap, which moves a quarter of a cell. The two rays are less than a quarter of
//     a cell apart, so t changes by less than a quarter of the new s_k, 2**E. This is added to r_k.
//  4. |a_k| is limited to 2**(E + 11). As 255 s_k is less than 2**(E + 10), all planes are then beyond 2**E, or all
//     behind the ray, as they are without the limit. If binary32 overflows on an axis, the axis excludes no box.
//  5. So no near plane is computed too far, and no far plane too near: the box is entered.
//
// Source: quantised boxes: Ylitie, Karras and Laine, "Efficient incoherent ray traversal on GPUs through
// compressed wide BVHs", 2017.
module box_unit
  import ray_core_pkg::*;
#(
  parameter int unsigned Rays = 64,
  parameter int unsigned Clocks = 1,  // clocks per node: 1, or Children or more
  parameter int unsigned Arith = arith_pkg::Graded,
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                clk_i,
  input  logic                rst_ni,
  input  logic [RayWidth-1:0] ctx_i,
  input  node_line_t          node_i,
  input  logic [95:0]         origin_i,
  input  logic [95:0]         inverse_i,
  input  logic [30:0]         t_max_i,
  output logic [RayWidth-1:0] ctx_o,
  output boxes_t              boxes_o
);

  localparam logic [UnitBits:0] Whole = (UnitBits + 1)'(1) << UnitBits;  // 2**E

  // Latencies of the stages, in clocks
  localparam int unsigned Take = 2;
  localparam int unsigned Subtract = hit_test_pkg::AdderLatency;
  localparam int unsigned Scale = 3;
  localparam int unsigned Multiply = hit_test_pkg::MultiplierLatency;
  localparam int unsigned Align = 2;
  localparam int unsigned Slab = 4;
  localparam int unsigned Sort = 4;
  localparam int unsigned Latency = BoxLatency + ((Clocks == 1) ? 0 : Children);

  if (BoxLatency != Take + Subtract + Scale + Multiply + Align + Slab + Sort
      || (Clocks != 1 && Clocks < Children)) begin : gen_check
    $error("box_unit: expected BoxLatency to be that of its stages, and Clocks of 1, or 7 or more");
  end

  // ---- Take

  logic [LineWidth-1:0] first_q, node_q;
  logic [95:0] origin_q, inverse_q;
  logic [30:0] t_max_q;
  logic [Latency:1] valid_q;  // [n]: a node came n clocks ago

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= '0;
    else valid_q <= {valid_q[Latency-1:1], node_i.valid};
  end
  delay_line #(
    .Width(RayWidth),
    .Depth(Latency)
  ) u_ctx (
    .clk_i,
    .enable_i(1'b1),
    .data_i(ctx_i),
    .data_o(ctx_o)
  );
  assign boxes_o.valid = valid_q[Latency];

  always_ff @(posedge clk_i) begin
    first_q <= node_i.line;
    if (node_i.error) first_q[NodeKinds+:Children*KindWidth] <= '0;  // all absent
    node_q  <= first_q;
    {origin_q, inverse_q, t_max_q} <= {origin_i, inverse_i, t_max_i};
  end

  // These words bypass the arithmetic: base, kinds and boxes of the node, and the ray's t_max
  localparam int unsigned Base = NodeBase;
  localparam int unsigned ChildrenWidth = LineWidth - Base;
  localparam int unsigned Kinds = NodeKinds - Base;
  localparam int unsigned Boxes = NodeBoxes - Base;

  typedef struct packed {
    logic [ChildrenWidth-1:0] children;
    logic [30:0]              t_max;
  } sideband_t;

  sideband_t taken, subtracted, scaled, multiplied;

  assign taken = {node_q[LineWidth-1:Base], t_max_q};

  // ---- Subtract

  logic [95:0] distance, inverse;
  logic [23:0] cells;

  fp_vector #(
    .Subtract(3'b111),
    .Arith(Arith)
  ) u_subtract (
    .clk_i,
    .step_i(1'b1),
    .a_i(node_q[NodeOrigin +: 96]),
    .b_i(origin_q),
    .result_o(distance)
  );
  delay_line #(
    .Width($bits(taken) + 96 + 24),
    .Depth(Subtract)
  ) u_sideband_subtract (
    .clk_i,
    .enable_i(1'b1),
    .data_i({taken, inverse_q, node_q[NodeExponents +: 24]}),
    .data_o({subtracted, inverse, cells})
  );

  // ---- Scale

  scale_t scale, scale_q, multiplied_scale;
  logic [95:0] scaled_distance;

  ray_scale u_scale (
    .clk_i,
    .distances_i({distance[94:87], distance[62:55], distance[30:23]}),
    .inverse_i(inverse),
    .cells_i(cells),
    .t_max_i(subtracted.t_max[30:23]),
    .scale_o(scale)
  );
  delay_line #(
    .Width($bits(taken) + 96),
    .Depth(Scale)
  ) u_sideband_scale (
    .clk_i,
    .enable_i(1'b1),
    .data_i({subtracted, distance}),
    .data_o({scaled, scaled_distance})
  );
  always_ff @(posedge clk_i) scale_q <= scale;

  // ---- Multiply

  logic [95:0] product;

  fp_vector #(
    .Multiply(1'b1),
    .Arith(Arith)
  ) u_multiply (
    .clk_i,
    .step_i(1'b1),
    .a_i(scaled_distance),
    .b_i(scale_q.inverse),
    .result_o(product)
  );
  delay_line #(
    .Width($bits(taken) + $bits(scale)),
    .Depth(Multiply)
  ) u_sideband_multiply (
    .clk_i,
    .enable_i(1'b1),
    .data_i({scaled, scale_q}),
    .data_o({multiplied, multiplied_scale})
  );

  // ---- Align

  logic [1:0][2:0][PlaneWidth-1:0] planes_q, next_planes_q;  // [0]: a_k - r_k; [1]: a_k + r_k
  logic [3*StepWidth-1:0] step_q;
  logic [2:0] back, aligned_back, next_back_q;
  logic [8:0] aligned_exponent, sorted_exponent;
  logic [ChildrenWidth-1:0] children;

  for (genvar k = 0; k < 3; k++) begin : gen_align
    logic [1:0][PlaneWidth-1:0] axis_planes;
    logic [StepWidth-1:0] axis_step;

    slab_setup #(
      .Arith(Arith)
    ) u_axis (
      .clk_i,
      .product_i(product[32*k +: 32]),
      .inverse_i(multiplied_scale.inverse[32*k +: 31]),
      .exponent_i(multiplied_scale.exponent),
      .cap_i(multiplied_scale.caps[11*k +: 11]),
      .is_capped_i(multiplied_scale.is_capped[k]),
      .is_open_i(multiplied_scale.is_open[k]),
      .planes_o(axis_planes),
      .step_o(axis_step)
    );
    assign back[k] = multiplied_scale.inverse[32*k+31];

    always_ff @(posedge clk_i) begin
      {planes_q[1][k], planes_q[0][k]} <= axis_planes;
      step_q[StepWidth*k +: StepWidth] <= axis_step;
    end
  end
  always_ff @(posedge clk_i) {next_planes_q, next_back_q} <= {planes_q, aligned_back};

  logic signed [10:0] t_max_amount;
  logic [UnitBits:0] t_max_shifted_q, t_max_units_q, entered_t_max;
  logic t_max_whole_q;
  assign t_max_amount = $signed(
    {2'b0, multiplied_scale.exponent}
  ) + 11'sd1 - $signed(
    {3'b0, multiplied.t_max[30:23]}
  );

  always_ff @(posedge clk_i) begin
    t_max_shifted_q <= (t_max_amount > 11'sd24) ? '0
                     : (UnitBits + 1)'({1'b1, multiplied.t_max[22:0]} >> t_max_amount[4:0]);
    t_max_whole_q   <= t_max_amount <= 11'sd1;
    t_max_units_q   <= t_max_whole_q ? Whole : t_max_shifted_q + (UnitBits + 1)'(1);
  end

  delay_line #(
    .Width(ChildrenWidth + 9 + 3),
    .Depth(Align)
  ) u_sideband_align (
    .clk_i,
    .enable_i(1'b1),
    .data_i({multiplied.children, multiplied_scale.exponent, back}),
    .data_o({children, aligned_exponent, aligned_back})
  );

  // ---- Step and enter: a key for each child, {not entered, enter}; all children at once, or one per clock

  localparam int unsigned Tests = (Clocks == 1) ? Children : 1;
  localparam int unsigned KeyWidth = UnitBits + 2;

  logic [Boxes-1:0] stepped_node, sorted_node;  // base and kinds of the node
  logic [8:0] stepped_exponent;
  logic [Children*KeyWidth-1:0] keys;
  logic [Tests*KeyWidth-1:0] tested;

  // Inputs of the slab tests: as they come or, if children are tested one per clock, kept until the last is tested
  logic [Children*BoxWidth-1:0] boxes;
  logic [2:0] step_back, next_back;
  logic [3*StepWidth-1:0] step;
  logic [1:0][2:0][PlaneWidth-1:0] next_planes;
  logic [UnitBits:0] t_max;
  logic [Children*KindWidth-1:0] kinds;

  delay_line #(
    .Width(UnitBits + 1),
    .Depth(Slab - 2)
  ) u_t_max (
    .clk_i,
    .enable_i(1'b1),
    .data_i(t_max_units_q),
    .data_o(entered_t_max)
  );
  delay_line #(
    .Width(Boxes + 9),
    .Depth(Slab - 1)
  ) u_sideband_step (
    .clk_i,
    .enable_i(1'b1),
    .data_i({children[Boxes-1:0], aligned_exponent}),
    .data_o({stepped_node, stepped_exponent})
  );
  delay_line #(
    .Width(Boxes + 9),
    .Depth((Clocks == 1) ? 1 : 1 + Children)
  ) u_sideband_sort (
    .clk_i,
    .enable_i(1'b1),
    .data_i({stepped_node, stepped_exponent}),
    .data_o({sorted_node, sorted_exponent})
  );

  for (genvar i = 0; i < Tests; i++) begin : gen_child
    slab_test #(
      .Arith(Arith)
    ) u_child (
      .clk_i,
      .box_i(boxes[BoxWidth*i +: BoxWidth]),
      .back_i(step_back),
      .step_i(step),
      .next_planes_i(next_planes),
      .next_back_i(next_back),
      .t_max_i(t_max),
      .kind_i(kinds[KindWidth*i +: KindWidth]),
      .key_o(tested[KeyWidth*i +: KeyWidth])
    );
  end

  if (Clocks == 1) begin : gen_all
    assign boxes = children[Boxes +: Children*BoxWidth];
    assign {step_back, step} = {aligned_back, step_q};
    assign {next_planes, next_back} = {next_planes_q, next_back_q};
    assign t_max = entered_t_max;
    assign kinds = stepped_node[Kinds +: Children*KindWidth];
    assign keys  = tested;
  end else begin : gen_turns
    localparam int unsigned Aligned = Take + Subtract + Scale + Multiply + Align;
    logic [(Children-1)*KeyWidth-1:0] keys_q;  // the latest is highest

    always_ff @(posedge clk_i) begin
      boxes <= valid_q[Aligned] ? children[Boxes +: Children*BoxWidth] : boxes >> BoxWidth;
      kinds <= valid_q[Aligned+3] ? stepped_node[Kinds +: Children*KindWidth] : kinds >> KindWidth;
      if (valid_q[Aligned]) {step_back, step} <= {aligned_back, step_q};
      if (valid_q[Aligned+1]) {next_planes, next_back} <= {next_planes_q, next_back_q};
      if (valid_q[Aligned+2]) t_max <= entered_t_max;
      keys_q <= keys[Children*KeyWidth-1:KeyWidth];
    end
    assign keys = {tested, keys_q};
  end

  // ---- Sort

  child_sort u_group (
    .clk_i,
    .keys_i(keys),
    .kinds_i(sorted_node[Kinds +: Children*KindWidth]),
    .base_i(sorted_node[0 +: AddressWidth]),
    .exponent_i(sorted_exponent),
    .group_o(boxes_o.group),
    .inner_o(boxes_o.inner),
    .leaf_o(boxes_o.leaf)
  );

endmodule
