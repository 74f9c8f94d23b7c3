// Fetch of primitives: asks for leaves' triangles, near leaves first. Throughput: a triangle a clock.
//
// Groups of leaves are served one at a time, in the order in which they came. A ray has at most one group here. A leaf
// that lies beyond the ray's t_max at its turn is dropped with the rest of the group, which is no nearer.
module primitive_fetch
  import ray_core_pkg::*;
#(
  parameter int unsigned Rays = 64,
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                clk_i,
  input  logic                rst_ni,
  input  logic                box_valid_i,
  input  logic [RayWidth-1:0] box_ray_i,
  input  group_t              box_group_i,
  input  logic [Children-1:0] box_leaf_i,
  output logic [RayWidth-1:0] t_max_ray_o,
  input  logic [30:0]         t_max_i,  // t_max of t_max_ray_o of the clock before
  input  logic                ended_i,  // the ray of t_max_i needs no more tests
  output logic [Rays-1:0]     leaf_pending_o,  // rays with a group here
  // requests for triangles
  output logic [RayWidth-1:0] triangle_ray_o,
  output request_t            triangle_o,
  input  logic                triangle_ready_i
);

  // ---- Waiting groups

  logic push, queued, load;
  logic [RayWidth-1:0] queued_ray;
  group_t queued_group, group_q;
  logic [Children-1:0] queued_leaf;

  assign push = box_valid_i & (box_leaf_i != '0);

  fifo #(
    .Width(RayWidth + GroupWidth + Children),
    .Depth(Rays),
    .Memory(1'b1)
  ) u_groups (
    .clk_i,
    .rst_ni,
    .push_i(push),
    .data_i({box_ray_i, box_group_i, box_leaf_i}),
    .space_o(),
    .pop_i(load),
    .valid_o(queued),
    .data_o({queued_ray, queued_group, queued_leaf})
  );

  // ---- The group whose turn it is

  logic valid_q;
  logic [RayWidth-1:0] ray_q;
  logic [Children-1:0] mask_q, lowest, remaining;
  logic [LeafWidth-1:0] number_q;  // number of the triangle in its leaf
  logic [ChildWidth-1:0] entry;
  logic beyond, fire, last, done;

  assign lowest    = mask_q & -mask_q;
  assign remaining = mask_q & ~lowest;

  always_comb begin
    entry = '0;
    for (int unsigned n = 0; n < Children; n++) begin
      if (lowest[n]) entry = group_q.entries[ChildWidth*n+:ChildWidth];
    end
  end

  assign t_max_ray_o = load ? queued_ray : ray_q;
  assign beyond = ended_i | is_beyond(entry[ChildWidth-1-:EnterWidth], t_max_i);
  assign triangle_o.valid = valid_q & ~beyond;
  assign triangle_ray_o   = ray_q;
  assign triangle_o.line  = group_q.base + AddressWidth'(entry[LeafWidth +: OffsetWidth])
                          + AddressWidth'(number_q);
  assign fire = triangle_o.valid & triangle_ready_i;
  assign last = number_q + 1'b1 == entry[LeafWidth-1:0];
  assign done = valid_q & (beyond | (fire & last & (remaining == '0)));
  assign load = queued & (~valid_q | done);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_q        <= 1'b0;
      leaf_pending_o <= '0;
    end else begin
      valid_q <= load | (valid_q & ~done);
      if (done) leaf_pending_o[ray_q] <= 1'b0;
      if (push) leaf_pending_o[box_ray_i] <= 1'b1;
    end
  end
  always_ff @(posedge clk_i) begin
    if (load) begin
      ray_q    <= queued_ray;
      group_q  <= queued_group;
      mask_q   <= queued_leaf;
      number_q <= '0;
    end else if (fire) begin
      number_q <= last ? '0 : number_q + 1'b1;
      if (last) mask_q <= remaining;
    end
  end

endmodule
