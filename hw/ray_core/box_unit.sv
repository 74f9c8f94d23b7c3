// Which children of a node a ray enters, near first: a node line and a ray in each clock.
//
//   take        node, ray                                                   registers
//   subtract    D_k = origin_k - O_k                                        3 adders
//   scale       2**E, how far the ray may go in this node; caps of 1 / I_k
//   multiply    a_k = D_k / I_k                                             3 multipliers
//   align       a_k and the grid's step s_k in units of 2**(E - 22), room r_k for errors
//   step        q s_k for the planes of all boxes                           42 multipliers, 8 x 33
//   enter       largest near plane, smallest far plane                      42 adders, comparators
//   sort        near first                                                  16 comparators, two stages
//
// No valid: what belongs to a node is the user's to carry along for BoxLatency clocks. Throughput one a clock.
//
// In:  node_i       a node line, see ray_core_pkg
//      origin_i     O, binary32; word x lowest, here and below
//      inverse_i    1 / I_k, rounded to nearest (infinite where I_k is zero); the largest I_k is in [1, 2)
//      limit_i      a positive binary32 number without its sign, or infinity: a hit farther than it is
//                   not wanted
//      every_box_i  all children are entered
// Out: group_o      ray_core_pkg's group; entries that are in neither mask mean nothing
//      inner_o, leaf_o  which entries there are, of which kind
//
// No box is left out in which the ray has a point O + t I with 0 < t <= limit, in exact arithmetic:
//
//  1. E. Such a t is at most (|origin_k - O_k| + 255 * 2**e_k) / |I_k| for each k (e_k without its bias), and
//     at most the limit. With D_k and 1 / I_k as computed the first is below 2**(M + exponent(1 / I_k) + 2),
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
// compressed wide BVHs", 2017; the sorting network is Batcher's for eight, less one input.
module box_unit #(
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded
) (
  input  logic                                clk_i,
  input  logic [ray_core_pkg::LineWidth-1:0]  node_i,
  input  logic [95:0]                         origin_i,
  input  logic [95:0]                         inverse_i,
  input  logic [30:0]                         limit_i,
  input  logic                                every_box_i,
  output logic [ray_core_pkg::GroupWidth-1:0] group_o,
  output logic [ray_core_pkg::Children-1:0]   inner_o,
  output logic [ray_core_pkg::Children-1:0]   leaf_o
);

  localparam int unsigned Children = ray_core_pkg::Children;
  localparam int unsigned EnterWidth = ray_core_pkg::EnterWidth;
  localparam int unsigned OffsetWidth = ray_core_pkg::OffsetWidth;
  localparam int unsigned CountWidth = ray_core_pkg::CountWidth;
  localparam int unsigned EntryWidth = ray_core_pkg::EntryWidth;

  localparam int unsigned UnitBits = 22;  // 2**E is 2**UnitBits units
  localparam int unsigned SizeWidth = 34;  // of |a|, up to 2**33
  localparam int unsigned StepWidth = 33;  // of s, up to 2**32, in 256ths of a unit
  localparam int unsigned PlaceWidth = 36;  // of sums, signed
  localparam logic [UnitBits:0] Whole = (UnitBits + 1)'(1) << UnitBits;

  if (ray_core_pkg::BoxLatency
      != 7 + hit_test_pkg::AdderLatency + hit_test_pkg::MultiplierLatency) begin : gen_check
    $error("box_unit: ray_core_pkg::BoxLatency is not the number of its stages");
  end

  // ---- Take

  logic [ray_core_pkg::LineWidth-1:0] node_q;
  logic [95:0] origin_q, inverse_q;
  logic [30:0] limit_q;
  logic every_box_q;

  always_ff @(posedge clk_i) begin
    node_q      <= node_i;
    origin_q    <= origin_i;
    inverse_q   <= inverse_i;
    limit_q     <= limit_i;
    every_box_q <= every_box_i;
  end

  // What goes along: all but the origins.
  localparam int unsigned BesideWidth = ray_core_pkg::LineWidth - 96;
  localparam int unsigned NodeBase = ray_core_pkg::NodeBase - 96;
  localparam int unsigned ChildrenWidth = BesideWidth - NodeBase;  // base, kinds and boxes
  logic [BesideWidth-1:0] sub_node;
  logic [95:0] sub_inverse;
  logic [30:0] sub_limit;
  logic sub_every_box;

  delay_line #(
    .Width(BesideWidth + 96 + 31 + 1),
    .Depth(hit_test_pkg::AdderLatency)
  ) u_beside_subtract (
    .clk_i,
    .enable_i(1'b1),
    .data_i({node_q[ray_core_pkg::LineWidth-1:96], inverse_q, limit_q, every_box_q}),
    .data_o({sub_node, sub_inverse, sub_limit, sub_every_box})
  );

  // ---- Subtract

  logic [95:0] distance;

  for (genvar k = 0; k < 3; k++) begin : gen_distance
    fp_pkg::flags_t unused_flags;

    fp_adder_stages #(
      .Arith(Arith),
      .Adder(Adder),
      .Cuts(hit_test_pkg::AdderCuts)
    ) u_subtract (
      .clk_i,
      .a_i(node_q[ray_core_pkg::NodeOrigin+32*k +: 32]),
      .b_i(origin_q[32*k +: 32]),
      .subtract_i(1'b1),
      .rounding_mode_i(fp_pkg::RoundNearestEven),
      .tininess_after_i(1'b0),
      .result_o(distance[32*k +: 32]),
      .flags_o(unused_flags)
    );
  end

  // ---- Scale: exponents with binary32's bias, in 11 signed bits

  localparam logic signed [10:0] NoExponent = 11'sd511;
  localparam logic signed [10:0] LeastExponent = 11'sd27;
  localparam int unsigned NodeExponents = ray_core_pkg::NodeExponents - 96;  // in what goes along

  logic signed [10:0] least, scale_exponent;
  logic [32:0] reaches;  // 11 bits an axis
  logic [32:0] caps;
  logic [95:0] capped_inverse;
  logic [2:0] capped, open;

  for (genvar k = 0; k < 3; k++) begin : gen_scale
    logic [7:0] distance_field, inverse_field, cell_field;
    logic signed [10:0] beyond, grid, reach, cap;
    assign distance_field = distance[32*k+23 +: 8];
    assign inverse_field  = sub_inverse[32*k+23 +: 8];
    assign cell_field     = sub_node[NodeExponents+8*k +: 8];
    assign beyond = $signed({3'b0, distance_field}) + 11'sd1;
    assign grid   = $signed({3'b0, cell_field}) + 11'sd8;
    assign reach  = ((beyond > grid) ? beyond : grid) + $signed({3'b0, inverse_field}) - 11'sd125;
    assign reaches[11*k +: 11] = (&inverse_field) ? NoExponent : reach;

    assign cap = scale_exponent - $signed({3'b0, cell_field}) + 11'sd129;
    assign caps[11*k +: 11] = cap;
    assign capped[k] = (&inverse_field) | ($signed({3'b0, inverse_field}) >= cap);
    assign open[k] = capped[k] & (cap < 11'sd1 | cap > 11'sd254);
    assign capped_inverse[32*k +: 32] =
        capped[k] ? {sub_inverse[32*k+31], cap[7:0], 23'd0} : sub_inverse[32*k +: 32];
  end

  always_comb begin
    least = (&sub_limit[30:23]) ? NoExponent : $signed({3'b0, sub_limit[30:23]}) + 11'sd1;
    for (int unsigned k = 0; k < 3; k++) begin
      if ($signed(reaches[11*k+:11]) < least) least = $signed(reaches[11*k+:11]);
    end
    scale_exponent = (least < LeastExponent) ? LeastExponent : least;
  end

  logic [95:0] scaled_distance_q, scaled_inverse_q;
  logic [ChildrenWidth-1:0] scaled_node_q;
  logic [32:0] scaled_caps_q;
  logic [30:0] scaled_limit_q;
  logic [2:0] scaled_capped_q, scaled_open_q;
  logic [8:0] scaled_exponent_q;
  logic scaled_every_box_q;

  always_ff @(posedge clk_i) begin
    scaled_distance_q  <= distance;
    scaled_inverse_q   <= capped_inverse;
    scaled_node_q      <= sub_node[BesideWidth-1:NodeBase];
    scaled_caps_q      <= caps;
    scaled_limit_q     <= sub_limit;
    scaled_capped_q    <= capped;
    scaled_open_q      <= open;
    scaled_exponent_q  <= scale_exponent[8:0];
    scaled_every_box_q <= sub_every_box;
  end

  // ---- Multiply

  logic [95:0] product, mul_inverse;
  logic [ChildrenWidth-1:0] mul_node;
  logic [32:0] mul_caps;
  logic [30:0] mul_limit;
  logic [2:0] mul_capped, mul_open;
  logic [8:0] mul_exponent;
  logic mul_every_box;

  for (genvar k = 0; k < 3; k++) begin : gen_product
    fp_pkg::flags_t unused_flags;

    fp_multiplier_stages #(
      .Arith(Arith),
      .Adder(Adder),
      .Cuts(hit_test_pkg::MultiplierCuts)
    ) u_multiply (
      .clk_i,
      .a_i(scaled_distance_q[32*k +: 32]),
      .b_i(scaled_inverse_q[32*k +: 32]),
      .rounding_mode_i(fp_pkg::RoundNearestEven),
      .tininess_after_i(1'b0),
      .result_o(product[32*k +: 32]),
      .flags_o(unused_flags)
    );
  end

  delay_line #(
    .Width(ChildrenWidth + 96 + 33 + 31 + 3 + 3 + 9 + 1),
    .Depth(hit_test_pkg::MultiplierLatency)
  ) u_beside_multiply (
    .clk_i,
    .enable_i(1'b1),
    .data_i({scaled_node_q, scaled_inverse_q, scaled_caps_q, scaled_limit_q, scaled_capped_q,
             scaled_open_q, scaled_exponent_q, scaled_every_box_q}),
    .data_o({mul_node, mul_inverse, mul_caps, mul_limit, mul_capped, mul_open, mul_exponent,
             mul_every_box})
  );

  // ---- Align

  logic [3*PlaceWidth-1:0] near_q, far_q;  // a_k -+ r_k
  logic [3*StepWidth-1:0] step_q;
  logic [2:0] back_q;
  logic [UnitBits:0] limit_units_q;
  logic [ChildrenWidth-1:0] aligned_node_q;
  logic [8:0] aligned_exponent_q;
  logic aligned_every_box_q;

  for (genvar k = 0; k < 3; k++) begin : gen_align
    logic [7:0] product_field, inverse_field;
    logic signed [10:0] amount, step_amount;
    logic [SizeWidth-1:0] size;
    logic [StepWidth-1:0] step;
    logic signed [PlaceWidth-1:0] a, room;
    logic says_nothing;

    assign product_field = product[32*k+23 +: 8];
    assign inverse_field = mul_inverse[32*k+23 +: 8];
    assign amount        = $signed({2'b0, mul_exponent}) + 11'sd11 - $signed({3'b0, product_field});
    assign step_amount   = $signed(mul_caps[11*k +: 11]) - $signed({3'b0, inverse_field});
    assign size = (amount <= 11'sd0) ? SizeWidth'(1) << (SizeWidth - 1)
                : (amount > 11'sd33) ? '0 : {1'b1, product[32*k +: 23], 10'b0} >> amount[5:0];
    assign step = (step_amount > 11'sd32) ? '0
                : {1'b1, mul_inverse[32*k +: 23], 9'b0} >> step_amount[5:0];
    assign a = product[32*k+31] ? -$signed({2'b0, size}) : $signed({2'b0, size});
    assign room = $signed(PlaceWidth'(size[SizeWidth-1:22]))
                + $signed(PlaceWidth'(step[StepWidth-1:24]))
                + $signed(PlaceWidth'(6)) + (mul_capped[k] ? $signed(PlaceWidth'(Whole)) : '0);
    assign says_nothing = mul_open[k] | (&product_field);

    always_ff @(posedge clk_i) begin
      near_q[PlaceWidth*k +: PlaceWidth] <=
          says_nothing ? -($signed(PlaceWidth'(1)) <<< 33) : a - room;
      far_q[PlaceWidth*k +: PlaceWidth] <= says_nothing ? $signed(PlaceWidth'(1)) <<< 33 : a + room;
      step_q[StepWidth*k +: StepWidth] <= says_nothing ? '0 : step;
      back_q[k] <= mul_inverse[32*k+31];
    end
  end

  logic signed [10:0] limit_amount;
  logic [UnitBits:0] limit_units;
  assign limit_amount = $signed({2'b0, mul_exponent}) + 11'sd1 - $signed({3'b0, mul_limit[30:23]});
  assign limit_units  = (limit_amount > 11'sd24) ? (UnitBits + 1)'(1)
                      : (UnitBits + 1)'({1'b1, mul_limit[22:0]} >> limit_amount[4:0])
                        + (UnitBits + 1)'(1);

  always_ff @(posedge clk_i) begin
    limit_units_q       <= (limit_amount <= 11'sd1) ? Whole : limit_units;
    aligned_node_q      <= mul_node;
    aligned_exponent_q  <= mul_exponent;
    aligned_every_box_q <= mul_every_box;
  end

  // ---- Step: q s for the near and the far plane of each box

  localparam int unsigned NodeBoxes = ray_core_pkg::NodeBoxes - ray_core_pkg::NodeBase;
  logic [Children*3*StepWidth-1:0] near_way_q, far_way_q;
  logic [3*PlaceWidth-1:0] step_near_q, step_far_q;
  logic [2:0] step_back_q;
  logic [UnitBits:0] step_limit_q;
  logic [NodeBoxes-1:0] step_node_q;  // base and kinds
  logic [8:0] step_exponent_q;
  logic step_every_box_q;

  for (genvar i = 0; i < Children; i++) begin : gen_step
    for (genvar k = 0; k < 3; k++) begin : gen_axis
      logic [7:0] low, high;
      logic [StepWidth-1:0] low_way, high_way;
      logic [StepWidth+7:0] step;
      assign low  = aligned_node_q[NodeBoxes+48*i+8*k +: 8];
      assign high = aligned_node_q[NodeBoxes+48*i+24+8*k +: 8];
      assign step     = (StepWidth + 8)'(step_q[StepWidth*k +: StepWidth]);
      assign low_way  = StepWidth'(((StepWidth + 8)'(low) * step) >> 8);
      assign high_way = StepWidth'(((StepWidth + 8)'(high) * step) >> 8);
      always_ff @(posedge clk_i) begin
        near_way_q[StepWidth*(3*i+k) +: StepWidth] <=
            back_q[k] ? high_way : low_way;
        far_way_q[StepWidth*(3*i+k) +: StepWidth] <=
            back_q[k] ? low_way : high_way;
      end
    end
  end

  always_ff @(posedge clk_i) begin
    step_near_q      <= near_q;
    step_far_q       <= far_q;
    step_back_q      <= back_q;
    step_limit_q     <= limit_units_q;
    step_node_q      <= aligned_node_q[NodeBoxes-1:0];
    step_exponent_q  <= aligned_exponent_q;
    step_every_box_q <= aligned_every_box_q;
  end

  // ---- Enter: keys {left out, enter, number of the child}

  localparam int unsigned NumberWidth = 3;
  localparam int unsigned KeyWidth = 1 + UnitBits + 1 + NumberWidth;
  localparam int unsigned Kinds = ray_core_pkg::NodeKinds - ray_core_pkg::NodeBase;
  localparam int unsigned KindWidth = ray_core_pkg::KindWidth;

  logic [Children*KeyWidth-1:0] keys_q, half_sorted_q, half_sorted, sorted;
  localparam int unsigned HeadWidth = ray_core_pkg::AddressWidth + Children * KindWidth + 9;
  logic [HeadWidth-1:0] keys_head_q, half_head_q;  // {exponent, kinds, base}

  for (genvar i = 0; i < Children; i++) begin : gen_enter
    logic signed [PlaceWidth-1:0] enter, leave;
    logic entered;

    always_comb begin : planes
      logic signed [PlaceWidth-1:0] near, far, near_from, far_from, near_way, far_way;
      enter = '0;
      leave = $signed(PlaceWidth'(step_limit_q));
      for (int unsigned k = 0; k < 3; k++) begin
        near_from = $signed(step_near_q[PlaceWidth*k +: PlaceWidth]);
        far_from  = $signed(step_far_q[PlaceWidth*k +: PlaceWidth]);
        near_way  = $signed({3'b0, near_way_q[StepWidth*(3*i+k) +: StepWidth]});
        far_way   = $signed({3'b0, far_way_q[StepWidth*(3*i+k) +: StepWidth]});
        near = step_back_q[k] ? near_from - near_way : near_from + near_way;
        far  = step_back_q[k] ? far_from - far_way : far_from + far_way;
        if (near > enter) enter = near;
        if (far < leave) leave = far;
      end
    end

    assign entered = (step_every_box_q | (enter <= leave))
                   & (step_node_q[Kinds+KindWidth*i +: KindWidth] != ray_core_pkg::KindAbsent);
    always_ff @(posedge clk_i) begin
      keys_q[KeyWidth*i+:KeyWidth] <= {
        ~entered,
        (entered & ~step_every_box_q) ? enter[UnitBits:0] : (UnitBits + 1)'(0),
        NumberWidth'(i)
      };
    end
  end

  always_ff @(posedge clk_i) begin
    keys_head_q   <= {step_exponent_q, step_node_q[Kinds+Children*KindWidth-1:0]};
    half_sorted_q <= half_sorted;
    half_head_q   <= keys_head_q;
  end

  // ---- Sort, in two stages

  function automatic logic [2*KeyWidth-1:0] in_order(logic [KeyWidth-1:0] a,
                                                     logic [KeyWidth-1:0] b);
    in_order = (a > b) ? {a, b} : {b, a};  // the smaller one lowest
  endfunction

  always_comb begin : first_half
    logic [KeyWidth-1:0] a, b, c, d, e, f, g;
    {g, f, e, d, c, b, a} = keys_q;
    {g, a} = in_order(a, g);
    {d, c} = in_order(c, d);
    {f, e} = in_order(e, f);
    {c, a} = in_order(a, c);
    {e, b} = in_order(b, e);
    {g, d} = in_order(d, g);
    {b, a} = in_order(a, b);
    {f, c} = in_order(c, f);
    {e, d} = in_order(d, e);
    half_sorted = {g, f, e, d, c, b, a};
  end
  always_comb begin : second_half
    logic [KeyWidth-1:0] a, b, c, d, e, f, g;
    {g, f, e, d, c, b, a} = half_sorted_q;
    {c, b} = in_order(b, c);
    {g, e} = in_order(e, g);
    {d, c} = in_order(c, d);
    {f, e} = in_order(e, f);
    {c, b} = in_order(b, c);
    {e, d} = in_order(d, e);
    {g, f} = in_order(f, g);
    sorted = {g, f, e, d, c, b, a};
  end

  // ---- The group

  logic [Children*OffsetWidth-1:0] offsets;  // of the children's first lines
  logic [Children*EntryWidth-1:0] entries;
  logic [Children-1:0] inner, leaf;

  always_comb begin : group
    logic [OffsetWidth-1:0] next;
    logic [KindWidth-1:0] kind;
    logic [KeyWidth-1:0] key;
    logic [NumberWidth-1:0] number;
    logic is_inner;
    next = '0;
    for (int unsigned i = 0; i < Children; i++) begin
      offsets[OffsetWidth*i +: OffsetWidth] = next;
      kind = half_head_q[ray_core_pkg::AddressWidth+KindWidth*i +: KindWidth];
      next = next + ((kind == ray_core_pkg::KindInner) ? OffsetWidth'(1)
                                                       : OffsetWidth'(kind[CountWidth-1:0]));
    end
    for (int unsigned n = 0; n < Children; n++) begin
      key = sorted[KeyWidth*n +: KeyWidth];
      number = key[NumberWidth-1:0];
      kind = half_head_q[ray_core_pkg::AddressWidth+KindWidth*number +: KindWidth];
      is_inner = kind == ray_core_pkg::KindInner;
      inner[n] = ~key[KeyWidth-1] & is_inner;
      leaf[n]  = ~key[KeyWidth-1] & ~is_inner;
      entries[EntryWidth*n +: EntryWidth] =
          {key[NumberWidth+UnitBits] ? {EnterWidth{1'b1}}
                                     : key[NumberWidth+UnitBits-1 -: EnterWidth],
           offsets[OffsetWidth*number +: OffsetWidth],
           is_inner ? CountWidth'(0) : kind[CountWidth-1:0]};
    end
  end

  always_ff @(posedge clk_i) begin
    group_o <= {half_head_q[ray_core_pkg::AddressWidth-1:0], half_head_q[HeadWidth-1 -: 9],
                entries};
    inner_o <= inner;
    leaf_o  <= leaf;
  end

endmodule
