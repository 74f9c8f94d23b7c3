// Traversal of the tree: short stacks, and which ray goes next.
//
// A stack entry is a group: the children of a node that a ray enters and has not visited yet, the nearest on top. In
// each clock one ray is picked, of those that neither wait for a node nor have leaves to be fetched. Its topmost groups
// are dropped while their nearest child lies beyond t_max. Then the topmost group's nearest child is requested. Rays
// with tests in flight, whose t_max may still fall, are picked after other rays and rays that start.
//
// Each ray has Depth groups of its own. Levels - Depth more groups are shared: one ray at a time holds them, on top of
// its own. A ray takes them when it requests a node and its own stack stays full; overflow_o is high in that clock. It
// holds them until its own stack has room again. Other rays that need them wait. The holder waits for no other ray, so
// each ray gets its turn. Of shared groups, only the topmost is examined. It is not dropped for t_max: if its children
// lie beyond t_max, box_unit finds none of their children.
//
// In a tree a ray enters each node once, and has at most one group for each level. A ray that is about to enter more
// than lines_i nodes, or that has Levels groups, is in a cycle: its stack is dropped, and cycle_o is high.
//
//   gather   the rays that may be picked
//   pick     one of them
//   read     its groups and its t_max
//   choose   the group
//   fetch    the group from memory
//   ask      request the line of the group's nearest child; in a clock without a group, the root for a ray that starts
module traversal
  import ray_core_pkg::*;
#(
  parameter int unsigned Rays  = 64,
  parameter int unsigned Depth = 8,  // groups on a ray's own stack
  parameter int unsigned Levels = MaxLevels,  // maximum number of groups, with the shared ones
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  // a ray begins
  input  logic                    start_valid_i,
  input  logic [RayWidth-1:0]     start_ray_i,
  output logic                    start_fire_o,
  // box_unit's result for a node
  input  logic                    box_valid_i,
  input  logic [RayWidth-1:0]     box_ray_i,
  input  group_t                  box_group_i,
  input  logic [Children-1:0]     box_inner_i,
  // state of rays
  input  logic [Rays-1:0]         leaf_pending_i,  // rays that have leaves to be fetched
  input  logic [Rays-1:0]         testing_i,  // rays that have tests in flight
  output logic [RayWidth-1:0]     t_max_ray_o,
  input  logic [30:0]             t_max_i,  // t_max of t_max_ray_o of the clock before
  input  logic                    ended_i,  // the ray of t_max_i needs no more nodes
  output logic                    cycle_o,  // cycle_ray_o is in a cycle
  output logic [RayWidth-1:0]     cycle_ray_o,
  input  logic [AddressWidth-1:0] lines_i,  // number of memory's lines; 0: 2**AddressWidth
  output logic [Rays-1:0]         traversing_o,  // rays that wait for a node or have a group
  // requests for nodes; at most one for each ray
  output logic [RayWidth-1:0]     node_ray_o,
  output request_t                node_o,
  output request_t                prefetch_o,  // the next child of the same group, if there is one
  output logic                    overflow_o  // a ray takes the shared groups
);

  localparam int unsigned LevelWidth = $clog2(Levels + 1);
  localparam int unsigned Shared = Levels - Depth;
  localparam int unsigned SharedWidth = $clog2(Shared);
  localparam int unsigned StackWidth = $clog2(Rays * Depth + Shared);

  localparam int unsigned NextWidth = Children + EnterWidth;

  if (Depth < 1 || Levels < Depth + 2) begin : gen_check
    $error("traversal: expected a Depth of 1 or more, and Levels of Depth + 2 or more");
  end

  logic [LevelWidth-1:0] levels[Rays];  // number of groups on the ray's stack
  logic [AddressWidth-1:0] entered[Rays];  // number of nodes entered
  logic [Rays-1:0] busy_q;     // the ray waits for a node, or is picked
  logic [Rays-1:0] waiting_q;  // the ray's levels is not 0
  logic [Rays-1:0] refused_q;  // the ray waits for the shared groups

  assign traversing_o = busy_q | waiting_q;

  // Return addresses of a ray's group of level `level`: in u_groups and, if the group is shared, in shared_masks.
  function automatic logic [StackWidth-1:0] stack_address(logic [RayWidth-1:0] ctx,
                                                          logic [LevelWidth-1:0] level);
    stack_address = StackWidth'(level) + ((level < LevelWidth'(Depth))
        ? StackWidth'(ctx) * StackWidth'(Depth) : StackWidth'((Rays - 1) * Depth));
  endfunction
  function automatic logic [SharedWidth-1:0] shared_address(logic [LevelWidth-1:0] level);
    shared_address = SharedWidth'(level - LevelWidth'(Depth));
  endfunction

  // Returns the nearest of the entries in `which`, as {enter, offset}; 0 if `which` is 0.
  function automatic logic [EnterWidth+OffsetWidth-1:0] nearest(
    logic [Children*ChildWidth-1:0] entries, logic [Children-1:0] which);
    nearest = '0;
    for (int unsigned n = 0; n < Children; n++) begin
      if (which[n] && (which & ((Children'(1) << n) - 1'b1)) == '0) begin
        nearest = entries[ChildWidth*n+LeafWidth+:EnterWidth+OffsetWidth];
      end
    end
  endfunction

  // ---- Gather: the rays that may be picked. A ray that is picked in this clock is masked by busy_q in the next

  logic [Rays-1:0] ready, sure, ready_q;

  assign ready = waiting_q & ~busy_q & ~leaf_pending_i & ~refused_q;
  assign sure  = ready & ~testing_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) ready_q <= '0;
    else ready_q <= (sure != '0 || start_valid_i) ? sure : ready;
  end

  // ---- Pick

  logic pick, picked_q, go;
  logic [RayWidth-1:0] picked_ray, ray_q;

  rr_arbiter #(
    .Width(Rays)
  ) u_pick (
    .requests_i(ready_q & ~busy_q),
    .start_i(ray_q),
    .valid_o(pick),
    .index_o(picked_ray)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      picked_q <= 1'b0;
      ray_q    <= '0;
    end else begin
      picked_q <= pick;
      if (pick) ray_q <= picked_ray;
    end
  end

  // ---- Read: for each group of the picked ray, the entries that wait and the `enter` of the nearest of these

  logic push, asked_q, choosing_q, ended_q, next_valid_q;
  logic [LevelWidth-1:0] box_level, level_q, chosen, left, asked_level_q, next_level_q;
  logic [RayWidth-1:0] choosing_ray_q, asking_ray_q, next_ray_q;
  logic [AddressWidth-1:0] entered_q;
  logic [30:0] t_max_q;
  logic [Depth-1:0] open;  // levels whose nearest child is not beyond t_max
  logic [Children-1:0] shared_masks[Shared], shared_mask_q;
  logic [Depth*Children-1:0] masks;
  logic [Children-1:0] mask, remaining, mask_q, remaining_q, next_remaining_q;
  logic [EnterWidth-1:0] box_enter, next_enter_q;

  assign t_max_ray_o = picked_ray;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) choosing_q <= 1'b0;
    else choosing_q <= picked_q;
  end
  always_ff @(posedge clk_i) begin
    choosing_ray_q <= ray_q;
    level_q        <= levels[ray_q];
    entered_q      <= entered[ray_q];
    t_max_q        <= t_max_i;
    ended_q        <= ended_i;

    if (next_valid_q && next_level_q >= LevelWidth'(Depth)) begin
      shared_masks[shared_address(next_level_q)] <= next_remaining_q;
    end
    if (push && box_level >= LevelWidth'(Depth)) begin
      shared_masks[shared_address(box_level)] <= box_inner_i;
    end
    shared_mask_q <= shared_masks[shared_address(levels[ray_q]-1'b1)];
  end

  for (genvar d = 0; d < Depth; d++) begin : gen_level
    logic [NextWidth-1:0] nexts[Rays];  // {waiting entries, enter of the nearest of them}
    logic [NextWidth-1:0] next_q;

    always_ff @(posedge clk_i) begin
      if (next_valid_q && next_level_q == LevelWidth'(d)) begin
        nexts[next_ray_q] <= {next_remaining_q, next_enter_q};
      end
      if (push && box_level == LevelWidth'(d)) nexts[box_ray_i] <= {box_inner_i, box_enter};
      next_q <= nexts[ray_q];
    end

    assign masks[Children*d +: Children] = next_q[NextWidth-1 -: Children];
    assign open[d] = (level_q > LevelWidth'(d)) & ~ended_q
                   & ~is_beyond(next_q[EnterWidth-1:0], t_max_q);
  end

  // ---- Choose

  logic is_shared, some, full, shared_q, free;
  logic [RayWidth-1:0] shared_ray_q;
  logic [Children-1:0] own_top;  // mask of the top of a full own stack

  assign is_shared = level_q > LevelWidth'(Depth);
  assign own_top   = masks[Children*(Depth-1) +: Children];

  always_comb begin
    some   = is_shared ? ~ended_q : open != '0;
    chosen = level_q - 1'b1;
    mask   = shared_mask_q;
    if (!is_shared) begin
      chosen = '0;
      mask   = '0;
      for (int unsigned d = 0; d < Depth; d++) begin
        if (open[d]) begin
          chosen = LevelWidth'(d);
          mask   = masks[Children*d +: Children];
        end
      end
    end
  end

  assign remaining   = mask & (mask - 1'b1);
  assign cycle_o     = choosing_q & some
                     & ((entered_q == lines_i) | (level_q == LevelWidth'(Levels)));
  assign cycle_ray_o = choosing_ray_q;
  assign left        = (~some | cycle_o) ? '0 : (remaining == '0) ? chosen : chosen + 1'b1;
  // Equivalent to `left` >= Depth, but available earlier.
  assign full        = ~cycle_o & (is_shared ? ~ended_q
                     : open[Depth-1] & ((own_top & (own_top - 1'b1)) != '0));
  assign free        = ~shared_q | (shared_ray_q == choosing_ray_q);
  assign go          = choosing_q & some & ~cycle_o & (~full | free);
  assign overflow_o  = go & full & ~shared_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      shared_q  <= 1'b0;
      refused_q <= '0;
    end else if (choosing_q) begin
      if (free) shared_q <= full;
      if (free && !full) refused_q <= '0;
      if (!free && full) refused_q[choosing_ray_q] <= 1'b1;
    end
  end
  always_ff @(posedge clk_i) if (overflow_o) shared_ray_q <= choosing_ray_q;

  // ---- Fetch

  logic next_started_q;
  logic [AddressWidth-1:0] base_q;
  group_t group;
  logic [OffsetWidth-1:0] offset_q, prefetch_offset_q;
  logic [EnterWidth-1:0] unused_enter;
  logic [OffsetWidth-1:0] unused_box_offset;

  assign start_fire_o = start_valid_i & ~asked_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) {asked_q, next_valid_q, next_started_q} <= '0;
    else {asked_q, next_valid_q, next_started_q} <= {go, asked_q, start_fire_o};
  end
  always_ff @(posedge clk_i) begin
    asking_ray_q  <= choosing_ray_q;
    asked_level_q <= chosen;
    mask_q        <= mask;
    remaining_q   <= remaining;

    next_ray_q       <= asked_q ? asking_ray_q : start_ray_i;
    next_level_q     <= asked_level_q;
    next_remaining_q <= remaining_q;
    base_q           <= asked_q ? group.base : '0;  // 0 for the root
    {unused_enter, offset_q}        <= nearest(group.entries, mask_q);
    {next_enter_q, prefetch_offset_q} <= nearest(group.entries, remaining_q);
  end

  // ---- Ask

  assign node_ray_o       = next_ray_q;
  assign node_o.valid     = next_valid_q | next_started_q;
  assign node_o.line      = base_q + (next_started_q ? '0 : AddressWidth'(offset_q));
  assign prefetch_o.valid = next_valid_q & (next_remaining_q != '0);
  assign prefetch_o.line  = base_q + AddressWidth'(prefetch_offset_q);

  // ---- Push what box_unit found

  assign box_level = levels[box_ray_i];
  assign push      = box_valid_i & (box_inner_i != '0);
  assign {box_enter, unused_box_offset} = nearest(box_group_i.entries, box_inner_i);

  ram #(
    .Width(GroupWidth),
    .Depth(Rays * Depth + Shared)
  ) u_groups (
    .clk_i,
    .write_i(push),
    .write_address_i(stack_address(box_ray_i, box_level)),
    .data_i(box_group_i),
    .read_i(go),
    .read_address_i(stack_address(choosing_ray_q, chosen)),
    .data_o(group)
  );

  // ---- State; in one clock, picking, start and a node's result concern different rays

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      busy_q    <= '0;
      waiting_q <= '0;
    end else begin
      if (pick) busy_q[picked_ray] <= 1'b1;
      if (start_fire_o) busy_q[start_ray_i] <= 1'b1;
      if (choosing_q && !go) busy_q[choosing_ray_q] <= 1'b0;
      if (box_valid_i) busy_q[box_ray_i] <= 1'b0;
      if (choosing_q) waiting_q[choosing_ray_q] <= left != '0;
      if (push) waiting_q[box_ray_i] <= 1'b1;
    end
  end
  always_ff @(posedge clk_i) begin
    if (start_fire_o) levels[start_ray_i] <= '0;
    if (start_fire_o) entered[start_ray_i] <= AddressWidth'(1);
    if (go) entered[choosing_ray_q] <= entered_q + 1'b1;
    if (choosing_q) levels[choosing_ray_q] <= left;
    if (push) levels[box_ray_i] <= box_level + 1'b1;
  end

endmodule
