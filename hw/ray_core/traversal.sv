// Traversal of the tree: a short stack of nodes for each ray, and the choice of the ray that goes to its next node.
//
// A stack holds groups of children that a ray enters, the nearest group last; of a group those not yet visited. Each
// clock one ray is picked that neither waits for a node nor has leaves pending. Groups whose nearest child is
// beyond t_max are dropped, all at once; the nearest child of the topmost group left is asked for. Rays without
// tests in flight come first: what they ask for is needed as far as anybody knows.
//
// A tree's ray enters each node once. One that is about to enter more than lines_i nodes meets a node again: its
// stack is dropped, cycle_o says so.
//
// Where a stack has no room for a group, the group leaves as an overflow: the host sends the ray there. Overflows
// are few; from two clocks after one has come until it has left no node is asked for: room for two more than there are
// rays is enough.
//
//   gather   the rays that may be picked
//   pick     one of them
//   read     what is known of it: its groups, its t_max
//   choose   its group
//   fetch    the group
//   ask      the node's line, out of the group; or, where there is none, a ray that starts (start_*) its first node
//
// A ray that starts goes before those that have tests in flight.
module traversal #(
  parameter int unsigned Rays  = 64,
  parameter int unsigned Depth = 8,  // groups on a stack, at least 1
  localparam int unsigned RayWidth = $clog2(Rays),
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth,
  localparam int unsigned GroupWidth = ray_core_pkg::GroupWidth,
  localparam int unsigned Children = ray_core_pkg::Children,
  localparam int unsigned NodesWidth = ray_core_pkg::NodesWidth
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  // a ray begins
  input  logic                    start_valid_i,
  input  logic [RayWidth-1:0]     start_ray_i,
  input  logic [AddressWidth-1:0] start_line_i,
  output logic                    start_fire_o,
  // what box_unit says of a node
  input  logic                    box_valid_i,
  input  logic [RayWidth-1:0]     box_ray_i,
  input  logic [31:0]             box_tag_i,  // the ray's, for overflows
  input  ray_core_pkg::group_t    box_group_i,
  input  logic [Children-1:0]     box_inner_i,
  // what is known of rays
  input  logic [Rays-1:0]         leaf_pending_i,  // has leaves to be asked for
  input  logic [Rays-1:0]         testing_i,   // has tests on their way
  output logic [RayWidth-1:0]     t_max_ray_o,
  input  logic [30:0]             t_max_i,     // of t_max_ray_o of the clock before
  input  logic                    ended_i,     // of that ray: it needs nothing any more
  output logic                    cycle_o,     // cycle_ray_o meets a node again
  output logic [RayWidth-1:0]     cycle_ray_o,
  input  logic [AddressWidth-1:0] lines_i,     // of memory; 0: 2**AddressWidth
  output logic [Rays-1:0]         traversing_o,  // waits for a node, or has some on its stack
  // nodes asked for; as many as there are rays at most
  output logic [RayWidth-1:0]     node_ray_o,
  output ray_core_pkg::request_t  node_o,
  output ray_core_pkg::request_t  prefetch_o,  // the next of the same group, where there is one
  output ray_core_pkg::overflow_t overflow_o,
  input  logic                    overflow_fire_i
);

  localparam int unsigned EntryWidth = ray_core_pkg::EntryWidth;
  localparam int unsigned OffsetWidth = ray_core_pkg::OffsetWidth;
  localparam int unsigned CountWidth = ray_core_pkg::CountWidth;
  localparam int unsigned EnterWidth = ray_core_pkg::EnterWidth;
  localparam int unsigned LevelWidth = $clog2(Depth + 1);
  localparam int unsigned StackAddressWidth = $clog2(Rays * Depth);

  localparam int unsigned NextWidth = Children + EnterWidth;

  if (Depth < 1) begin : gen_check
    $error("traversal: expected a Depth of 1 or more");
  end

  logic [LevelWidth-1:0] levels[Rays];  // groups on the stack
  logic [AddressWidth-1:0] entered[Rays];  // nodes
  logic [Rays-1:0] busy_q;     // waits for a node
  logic [Rays-1:0] waiting_q;  // levels is not 0

  assign traversing_o = busy_q | waiting_q;

  function automatic logic [StackAddressWidth-1:0] stack_address(logic [RayWidth-1:0] ctx,
                                                                 logic [LevelWidth-1:0] depth);
    stack_address = StackAddressWidth'(ctx) * StackAddressWidth'(Depth) + StackAddressWidth'(depth);
  endfunction

  // The nearest of the entries that are among `which`, 0 for none: {enter, offset}.
  function automatic logic [EnterWidth+OffsetWidth-1:0] nearest(
    logic [Children*EntryWidth-1:0] entries, logic [Children-1:0] which);
    nearest = '0;
    for (int unsigned n = 0; n < Children; n++) begin
      if (which[n] && (which & ((Children'(1) << n) - 1'b1)) == '0) begin
        nearest = entries[EntryWidth*n+CountWidth+:EnterWidth+OffsetWidth];
      end
    end
  endfunction

  // ---- Gather: none that is picked in this clock or was in the last one

  logic [Rays-1:0] ready, sure, ready_q;

  assign ready = waiting_q & ~busy_q & ~leaf_pending_i;
  assign sure  = ready & ~testing_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) ready_q <= '0;
    else ready_q <= (sure != '0 || start_valid_i) ? sure : ready;
  end

  // ---- Pick

  logic some, pick, picked_q, go;
  logic [RayWidth-1:0] picked_ray, ray_q;

  assign pick = some & ~overflow_o.valid;

  rr_arbiter #(
    .Width(Rays)
  ) u_pick (
    .requests_i(ready_q & ~busy_q),
    .start_i(ray_q),
    .valid_o(some),
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

  // ---- Read: of each level of the stack is known which entries wait, and where the first begins

  logic push, asked_q, choosing_q, ended_q, next_valid_q;
  logic [LevelWidth-1:0] box_level, level_q, chosen, left, asked_level_q, next_level_q;
  logic [RayWidth-1:0] choosing_ray_q, asking_ray_q, next_ray_q;
  logic [AddressWidth-1:0] entered_q;
  logic [30:0] t_max_q;
  logic [Depth-1:0] open;  // levels that have a child within the t_max
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
  end

  for (genvar d = 0; d < Depth; d++) begin : gen_level
    logic [NextWidth-1:0] nexts[Rays];  // {mask, enter}
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
                   & ~ray_core_pkg::is_beyond(next_q[EnterWidth-1:0], t_max_q);
  end

  // ---- Choose

  always_comb begin
    chosen = '0;
    mask   = '0;
    for (int unsigned d = 0; d < Depth; d++) begin
      if (open[d]) begin
        chosen = LevelWidth'(d);
        mask   = masks[Children*d +: Children];
      end
    end
  end

  assign remaining   = mask & (mask - 1'b1);
  assign cycle_o     = choosing_q & (open != '0) & (entered_q == lines_i);
  assign cycle_ray_o = choosing_ray_q;
  assign go          = choosing_q & (open != '0) & ~cycle_o;
  assign left        = ~go ? '0 : (remaining == '0) ? chosen : chosen + 1'b1;

  // ---- Fetch

  logic next_started_q;
  logic [AddressWidth-1:0] base_q;
  ray_core_pkg::group_t group;
  logic [OffsetWidth-1:0] offset_q, prefetch_offset_q;
  logic [EnterWidth-1:0] unused_enter;
  logic [OffsetWidth-1:0] unused_box_offset;

  assign start_fire_o = start_valid_i & ~asked_q & ~overflow_o.valid;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      {asked_q, next_valid_q, next_started_q} <= '0;
    end else begin
      {asked_q, next_valid_q, next_started_q} <= {go, asked_q, start_fire_o};
    end
  end
  always_ff @(posedge clk_i) begin
    asking_ray_q  <= choosing_ray_q;
    asked_level_q <= chosen;
    mask_q        <= mask;
    remaining_q   <= remaining;

    next_ray_q       <= asked_q ? asking_ray_q : start_ray_i;
    next_level_q     <= asked_level_q;
    next_remaining_q <= remaining_q;
    base_q           <= asked_q ? group.base : start_line_i;
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

  logic room;

  assign box_level = levels[box_ray_i];
  assign room      = box_level != LevelWidth'(Depth);
  assign push      = box_valid_i & (box_inner_i != '0) & room;
  assign {box_enter, unused_box_offset} = nearest(box_group_i.entries, box_inner_i);

  ram #(
    .Width(GroupWidth),
    .Depth(Rays * Depth)
  ) u_groups (
    .clk_i,
    .write_i(push),
    .write_address_i(stack_address(box_ray_i, box_level)),
    .data_i(box_group_i),
    .read_i(go),
    .read_address_i(stack_address(choosing_ray_q, chosen)),
    .data_o(group)
  );

  // ---- State; a ray is picked, starts, or hears of a node, never two of these at once

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

  // ---- Overflows

  logic [NodesWidth-1:0] nodes;
  logic unused_space;

  always_comb begin
    nodes = '0;
    for (int unsigned n = 0; n < Children; n++) begin
      if (box_inner_i[n]) nodes[box_group_i.entries[EntryWidth*n+CountWidth+:OffsetWidth]] = 1'b1;
    end
  end

  ram_fifo #(
    .Width(32 + AddressWidth + NodesWidth),
    .Depth(Rays + 2)
  ) u_overflows (
    .clk_i,
    .rst_ni,
    .push_i(box_valid_i & (box_inner_i != '0) & ~room),
    .data_i({box_tag_i, box_group_i.base, nodes}),
    .space_o(unused_space),
    .pop_i(overflow_fire_i),
    .valid_o(overflow_o.valid),
    .data_o({overflow_o.tag, overflow_o.line, overflow_o.nodes})
  );

endmodule
