// Box test: which children of a node a ray enters, near first; a node line and a ray in each clock.
// Latency: ray_core_pkg::BoxLatency clocks.
//
//   take        node, ray                                                   registers
//   subtract    D_k = origin_k - O_k                                        3 adders
//   scale       2**E, how far the ray may go in this node; caps of 1 / I_k  see ray_scale
//   multiply    a_k = D_k / I_k                                             3 multipliers
//   align       a_k and the grid's step s_k in units of 2**(E - 22),        see slab_setup
//               room r_k for errors
//   step        q s_k for the planes of all boxes                           42 multipliers, 8 x 33, see slab_test
//   enter       largest near plane, smallest far plane                      42 adders, 49 comparators
//   sort        near first; the group                                       see child_sort, sort7
//
// No valid: what belongs to a node is the user's to carry along. Of its ray t_max_i comes with the node, the rest a
// clock later, out of a memory.
//
// In:  node_i       a node line, see ray_core_pkg
//      origin_i     O, binary32; word x lowest, here and below
//      inverse_i    1 / I_k, rounded to nearest (infinite where I_k is zero); the largest I_k is in [1, 2)
//      t_max_i      a positive binary32 number without its sign, or infinity: a hit farther than it is
//                   not wanted
//      no_cull_i    all children are entered
// Out: group_o      ray_core_pkg's group; entries that are in neither mask mean nothing
//      inner_o, leaf_o  which entries there are, of which kind
//
// No box is left out in which the ray has a point O + t I with 0 < t <= t_max, in exact arithmetic:
//
//  1. E. Such a t is at most (|origin_k - O_k| + 255 * 2**e_k) / |I_k| for each k (e_k without its bias), and
//     at most the t_max. With D_k and 1 / I_k as computed the first is below 2**(M + exponent(1 / I_k) + 2),
//     where 2**M is above |D_k| and 2**(e_k + 8): the rounding of D_k is less than 2**e_k to spare. E is the
//     least of these exponents, but at least -100, so that what underflows is less than a unit.
//  2. A plane of the grid is met at t = (D_k + q 2**e_k) / I_k = a_k +- q s_k, with s_k = 2**e_k / |I_k|.
//     a_k is off by three roundings, 3.01 * 2**-24 of itself, and 1 unit by being cut off; q s_k by one
//     rounding, 2**-24 of itself, and 2 units by being cut off twice. r_k is |a_k| 2**-22 + 256 s_k 2**-24
//     + 6 units, each cut off, which is more.
//  3. Where s_k is above 2**(E + 2), or infinite, the ray moves less than a quarter of a cell along k as
//     long as t < 2**E. A ray with s_k = 2**(E + 2) in its place moves less than that, too: the two are less
//     than a quarter of a cell apart, which that ray makes in 2**E. So 2**E is added to r_k.
//  4. |a_k| of 2**(E + 11) and more is given as 2**(E + 11): 255 s_k is less than 2**(E + 10), so that all planes
//     are beyond 2**E, or all behind the ray, either way. An axis along which the numbers would
//     overflow says nothing: all its planes are met.
//  5. So near planes are computed too near, far ones too far, and comparing them leaves nothing out.
//
// Source: quantised boxes: Ylitie, Karras and Laine, "Efficient incoherent ray traversal on GPUs through
// compressed wide BVHs", 2017.
module box_unit #(
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded
) (
  input  logic                                clk_i,
  input  logic [ray_core_pkg::LineWidth-1:0]  node_i,
  input  logic [95:0]                         origin_i,
  input  logic [95:0]                         inverse_i,
  input  logic [30:0]                         t_max_i,
  input  logic                                no_cull_i,
  output logic [ray_core_pkg::GroupWidth-1:0] group_o,
  output logic [ray_core_pkg::Children-1:0]   inner_o,
  output logic [ray_core_pkg::Children-1:0]   leaf_o
);

  localparam int unsigned Children = ray_core_pkg::Children;
  localparam int unsigned KindWidth = ray_core_pkg::KindWidth;
  localparam int unsigned UnitBits = ray_core_pkg::UnitBits;
  localparam int unsigned StepWidth = ray_core_pkg::StepWidth;
  localparam int unsigned PlaneWidth = ray_core_pkg::PlaneWidth;
  localparam logic [UnitBits:0] Whole = (UnitBits + 1)'(1) << UnitBits;  // 2**E

  if (ray_core_pkg::BoxLatency
      != 7 + hit_test_pkg::AdderLatency + hit_test_pkg::MultiplierLatency) begin : gen_check
    $error("box_unit: ray_core_pkg::BoxLatency is not the number of its stages");
  end

  // ---- Take

  logic [ray_core_pkg::LineWidth-1:0] node_q;
  logic [30:0] t_max_q;

  always_ff @(posedge clk_i) begin
    node_q  <= node_i;
    t_max_q <= t_max_i;
  end

  // What goes along: all but the origins.
  localparam int unsigned SidebandWidth = ray_core_pkg::LineWidth - 96;
  localparam int unsigned NodeBase = ray_core_pkg::NodeBase - 96;
  localparam int unsigned ChildrenWidth = SidebandWidth - NodeBase;  // base, kinds and boxes
  logic [SidebandWidth-1:0] sub_node;
  logic [95:0] sub_inverse;
  logic [30:0] sub_t_max;
  logic sub_no_cull;

  delay_line #(
    .Width(SidebandWidth + 96 + 31 + 1),
    .Depth(hit_test_pkg::AdderLatency)
  ) u_sideband_subtract (
    .clk_i,
    .enable_i(1'b1),
    .data_i({node_q[ray_core_pkg::LineWidth-1:96], inverse_i, t_max_q, no_cull_i}),
    .data_o({sub_node, sub_inverse, sub_t_max, sub_no_cull})
  );

  // ---- Subtract

  logic [95:0] distance;

  vec_add #(
    .Subtract(1'b1),
    .Arith(Arith),
    .Adder(Adder)
  ) u_subtract (
    .clk_i,
    .a_i(node_q[ray_core_pkg::NodeOrigin +: 96]),
    .b_i(origin_i),
    .sum_o(distance)
  );

  // ---- Scale

  localparam int unsigned NodeExponents = ray_core_pkg::NodeExponents - 96;  // in what goes along

  logic [8:0] scale_exponent;
  logic [32:0] caps;
  logic [95:0] capped_inverse;
  logic [2:0] capped, open;

  ray_scale u_scale (
    .distances_i({distance[94:87], distance[62:55], distance[30:23]}),
    .inverse_i(sub_inverse),
    .cells_i(sub_node[NodeExponents +: 24]),
    .t_max_i(sub_t_max[30:23]),
    .exponent_o(scale_exponent),
    .inverse_o(capped_inverse),
    .caps_o(caps),
    .is_capped_o(capped),
    .is_open_o(open)
  );

  logic [95:0] scaled_distance_q, scaled_inverse_q;
  logic [ChildrenWidth-1:0] scaled_node_q;
  logic [32:0] scaled_caps_q;
  logic [30:0] scaled_t_max_q;
  logic [2:0] scaled_capped_q, scaled_open_q;
  logic [8:0] scaled_exponent_q;
  logic scaled_no_cull_q;

  always_ff @(posedge clk_i) begin
    scaled_distance_q <= distance;
    scaled_inverse_q  <= capped_inverse;
    scaled_node_q     <= sub_node[SidebandWidth-1:NodeBase];
    scaled_caps_q     <= caps;
    scaled_t_max_q    <= sub_t_max;
    scaled_capped_q   <= capped;
    scaled_open_q     <= open;
    scaled_exponent_q <= scale_exponent;
    scaled_no_cull_q  <= sub_no_cull;
  end

  // ---- Multiply

  logic [95:0] product, mul_inverse;
  logic [ChildrenWidth-1:0] mul_node;
  logic [32:0] mul_caps;
  logic [30:0] mul_t_max;
  logic [2:0] mul_capped, mul_open;
  logic [8:0] mul_exponent;
  logic mul_no_cull;

  vec_mul #(
    .Arith(Arith),
    .Adder(Adder)
  ) u_multiply (
    .clk_i,
    .a_i(scaled_distance_q),
    .b_i(scaled_inverse_q),
    .product_o(product)
  );
  delay_line #(
    .Width(ChildrenWidth + 96 + 33 + 31 + 3 + 3 + 9 + 1),
    .Depth(hit_test_pkg::MultiplierLatency)
  ) u_sideband_multiply (
    .clk_i,
    .enable_i(1'b1),
    .data_i({scaled_node_q, scaled_inverse_q, scaled_caps_q, scaled_t_max_q, scaled_capped_q,
             scaled_open_q, scaled_exponent_q, scaled_no_cull_q}),
    .data_o({mul_node, mul_inverse, mul_caps, mul_t_max, mul_capped, mul_open, mul_exponent,
             mul_no_cull})
  );

  // ---- Align

  logic [3*PlaneWidth-1:0] near_q, far_q;  // a_k -+ r_k
  logic [3*StepWidth-1:0] step_q;
  logic [2:0] back_q;
  logic [UnitBits:0] t_max_units_q;
  logic [ChildrenWidth-1:0] aligned_node_q;
  logic [8:0] aligned_exponent_q;
  logic aligned_no_cull_q;

  for (genvar k = 0; k < 3; k++) begin : gen_align
    logic [PlaneWidth-1:0] near, far;
    logic [StepWidth-1:0] step;

    slab_setup #(
      .Arith(Arith),
      .Adder(Adder)
    ) u_axis (
      .product_i(product[32*k +: 32]),
      .inverse_i(mul_inverse[32*k +: 31]),
      .exponent_i(mul_exponent),
      .cap_i(mul_caps[11*k +: 11]),
      .is_capped_i(mul_capped[k]),
      .is_open_i(mul_open[k]),
      .near_o(near),
      .far_o(far),
      .step_o(step)
    );

    always_ff @(posedge clk_i) begin
      near_q[PlaneWidth*k +: PlaneWidth] <= near;
      far_q[PlaneWidth*k +: PlaneWidth]  <= far;
      step_q[StepWidth*k +: StepWidth]   <= step;
      back_q[k]                          <= mul_inverse[32*k+31];
    end
  end

  logic signed [10:0] t_max_amount;
  logic [UnitBits:0] t_max_units;
  assign t_max_amount = $signed({2'b0, mul_exponent}) + 11'sd1 - $signed({3'b0, mul_t_max[30:23]});
  assign t_max_units  = (t_max_amount > 11'sd24) ? (UnitBits + 1)'(1)
                      : (UnitBits + 1)'({1'b1, mul_t_max[22:0]} >> t_max_amount[4:0])
                        + (UnitBits + 1)'(1);

  always_ff @(posedge clk_i) begin
    t_max_units_q      <= (t_max_amount <= 11'sd1) ? Whole : t_max_units;
    aligned_node_q     <= mul_node;
    aligned_exponent_q <= mul_exponent;
    aligned_no_cull_q  <= mul_no_cull;
  end

  // ---- Step and enter: a key for each child, {left out, enter}

  localparam int unsigned NodeBoxes = ray_core_pkg::NodeBoxes - ray_core_pkg::NodeBase;
  localparam int unsigned BoxWidth = ray_core_pkg::BoxWidth;
  localparam int unsigned Kinds = ray_core_pkg::NodeKinds - ray_core_pkg::NodeBase;
  localparam int unsigned KeyWidth = UnitBits + 2;

  logic [3*PlaneWidth-1:0] step_near_q, step_far_q;
  logic [2:0] step_back_q;
  logic [UnitBits:0] step_t_max_q;
  logic [NodeBoxes-1:0] step_node_q, keys_node_q;  // base and kinds
  logic [8:0] step_exponent_q, keys_exponent_q;
  logic step_no_cull_q;
  logic [Children*KeyWidth-1:0] keys;

  always_ff @(posedge clk_i) begin
    step_near_q     <= near_q;
    step_far_q      <= far_q;
    step_back_q     <= back_q;
    step_t_max_q    <= t_max_units_q;
    step_node_q     <= aligned_node_q[NodeBoxes-1:0];
    step_exponent_q <= aligned_exponent_q;
    step_no_cull_q  <= aligned_no_cull_q;
    keys_node_q     <= step_node_q;
    keys_exponent_q <= step_exponent_q;
  end

  for (genvar i = 0; i < Children; i++) begin : gen_child
    slab_test #(
      .Arith(Arith),
      .Adder(Adder)
    ) u_child (
      .clk_i,
      .box_i(aligned_node_q[NodeBoxes+BoxWidth*i +: BoxWidth]),
      .back_i(back_q),
      .step_i(step_q),
      .near_i(step_near_q),
      .far_i(step_far_q),
      .next_back_i(step_back_q),
      .t_max_i(step_t_max_q),
      .kind_i(step_node_q[Kinds+KindWidth*i +: KindWidth]),
      .no_cull_i(step_no_cull_q),
      .key_o(keys[KeyWidth*i +: KeyWidth])
    );
  end

  // ---- Sort

  child_sort #(
    .Arith(Arith)
  ) u_group (
    .clk_i,
    .keys_i(keys),
    .kinds_i(keys_node_q[Kinds +: Children*KindWidth]),
    .base_i(keys_node_q[0 +: ray_core_pkg::AddressWidth]),
    .exponent_i(keys_exponent_q),
    .group_o,
    .inner_o,
    .leaf_o
  );

endmodule
