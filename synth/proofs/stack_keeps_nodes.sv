// Claims, from reset on, for any results of box_unit: A pushed node is requested once, by the line number in its group,
// or is dropped when the ray's stack is examined: because the node is beyond the ray's t_max, or because the ray has
// ended or has met a node twice. A ray is `traversing` until its nodes are requested or dropped. A group is pushed
// only if there is room, on the ray's own stack or on the shared stack. One ray at a time owns the shared stack, for as
// long as this ray needs room there. Another ray that needs the shared stack waits until the owner, a traversing ray,
// releases the stack. opened_traversal is traversal of two rays, with room for two groups each and for two groups in
// the shared stack, and with its state as outputs.
module stack_keeps_nodes #(
  localparam int unsigned Rays  = 2,
  localparam int unsigned Depth = 2,
  localparam int unsigned Levels = 4,
  localparam int unsigned Children = ray_core_pkg::Children,
  localparam int unsigned GroupWidth = ray_core_pkg::GroupWidth,
  localparam int unsigned EntryWidth = ray_core_pkg::ChildWidth,
  localparam int unsigned EnterWidth = ray_core_pkg::EnterWidth,
  localparam int unsigned OffsetWidth = ray_core_pkg::OffsetWidth,
  localparam int unsigned CountWidth = ray_core_pkg::LeafWidth,
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth,
  localparam int unsigned NextWidth = Children + EnterWidth
) (
  input logic                  clk,
  input logic                  start,
  input logic                  start_ray,
  input logic                  box,
  input logic                  box_ray,
  input logic [Children-1:0]   box_inner,
  input logic [Rays-1:0]       leaf_pending,
  input logic [Rays-1:0]       testing,
  input logic [30:0]           t_max,
  input logic                  ended,
  input logic                  choose,  // watch child `which` of the group pushed in this clock
  input logic [2:0]            which
);

  logic reset_n;  // low for the first clock
  initial reset_n = 1'b0;
  always_ff @(posedge clk) reset_n <= 1'b1;

  (* anyconst *) logic [AddressWidth-1:0] lines;
  (* anyseq *) logic [GroupWidth-1:0] box_group;

  logic start_fire, node, node_ray, overflow, cycle, push, shared_q, shared_ray_q;
  logic [Rays-1:0] refused_q;
  logic t_max_ray;
  logic [AddressWidth-1:0] node_line;
  logic [Rays-1:0] traversing, busy_q, waiting_q;
  // Per stage: whether the stage has a picked ray or a starting ray, and the number of this ray
  logic picked_q, ray_q, choosing_q, choosing_ray_q, asked_q, asking_ray_q;
  logic next_valid_q, next_started_q, next_ray_q;
  logic [Rays-1:0] ready_q;
  logic ended_q;
  logic [30:0] t_max_q;
  logic [2:0] level_q, asked_level_q, next_level_q, left;
  logic [Children-1:0] shared_mask_q, mask_q, remaining_q, next_remaining_q;
  logic [EnterWidth-1:0] next_enter_q;
  logic [AddressWidth-1:0] base_q;
  logic [OffsetWidth-1:0] offset_q;
  logic [Rays*3-1:0] levels;
  logic [NextWidth-1:0] next_q_0, next_q_1;
  logic [Rays*NextWidth-1:0] nexts_0, nexts_1;
  logic [(Levels-Depth)*Children-1:0] shared_masks;
  logic [(Rays*Depth+Levels-Depth)*GroupWidth-1:0] groups;
  logic [GroupWidth-1:0] group_q;  // the group at the requested level

  opened_traversal dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .start_valid_i(start),
    .start_ray_i(start_ray),
    .start_fire_o(start_fire),
    .box_valid_i(box),
    .box_ray_i(box_ray),
    .box_group_i(box_group),
    .box_inner_i(box_inner),
    .leaf_pending_i(leaf_pending),
    .testing_i(testing),
    .t_max_ray_o(t_max_ray),
    .t_max_i(t_max),
    .ended_i(ended),
    .cycle_o(cycle),
    .lines_i(lines),
    .traversing_o(traversing),
    .node_ray_o(node_ray),
    .node_o({node, node_line}),
    .overflow_o(overflow),
    .push(push),
    .left(left),
    .shared_q(shared_q),
    .shared_ray_q(shared_ray_q),
    .refused_q(refused_q),
    .shared_mask_q(shared_mask_q),
    .shared_masks(shared_masks),
    .busy_q(busy_q),
    .waiting_q(waiting_q),
    .ready_q(ready_q),
    .picked_q(picked_q),
    .ray_q(ray_q),
    .choosing_q(choosing_q),
    .choosing_ray_q(choosing_ray_q),
    .level_q(level_q),
    .t_max_q(t_max_q),
    .ended_q(ended_q),
    .asked_q(asked_q),
    .asking_ray_q(asking_ray_q),
    .asked_level_q(asked_level_q),
    .mask_q(mask_q),
    .remaining_q(remaining_q),
    .next_valid_q(next_valid_q),
    .next_started_q(next_started_q),
    .next_ray_q(next_ray_q),
    .next_level_q(next_level_q),
    .next_remaining_q(next_remaining_q),
    .next_enter_q(next_enter_q),
    .base_q(base_q),
    .offset_q(offset_q),
    .levels(levels),
    .group(group_q),
    .u_groups_words(groups),
    .\gen_level[0]_nexts (nexts_0),
    .\gen_level[1]_nexts (nexts_1),
    .\gen_level[0].next_q (next_q_0),
    .\gen_level[1].next_q (next_q_1)
  );

  // ---- Entries of a group

  function automatic logic [EnterWidth-1:0] enter_of(logic [GroupWidth-1:0] group, logic [2:0] n);
    enter_of = group[EntryWidth*n+CountWidth+OffsetWidth+:EnterWidth];
  endfunction
  function automatic logic [AddressWidth-1:0] line_of(logic [GroupWidth-1:0] group, logic [2:0] n);
    line_of = group[GroupWidth-1-:AddressWidth] + AddressWidth'(group[EntryWidth*n+CountWidth+:OffsetWidth]);
  endfunction

  // ---- Assumptions about the user: no traversing ray starts again, only requested nodes come, near children first

  logic [Rays-1:0] wanted;  // per ray: a requested node has not arrived

  function automatic logic is_sorted(logic [GroupWidth-1:0] group);
    is_sorted = 1'b1;
    for (int unsigned n = 0; n < Children - 1; n++) begin
      if (group[EntryWidth*n+CountWidth+OffsetWidth+:EnterWidth]
          > group[EntryWidth*(n+1)+CountWidth+OffsetWidth+:EnterWidth]) is_sorted = 1'b0;
    end
  endfunction

  always_ff @(posedge clk) begin
    if (!reset_n) begin
      wanted <= '0;
    end else begin
      if (node) wanted[node_ray] <= 1'b1;
      if (box) wanted[box_ray] <= 1'b0;
    end
  end
  always_comb begin
    if (reset_n) begin
      assume (!start || !traversing[start_ray]);
      assume (!box || (wanted[box_ray] && is_sorted(box_group)));
    end else begin
      assume (!start && !box);
    end
  end

  // ---- The watched node

  logic watching, done, w_ray, w_own, dropped;
  logic [1:0] w_level;
  logic [2:0] w_entry;
  logic [GroupWidth-1:0] w_group;
  logic [2:0] box_level, w_levels;
  logic asked, present, push_here;
  logic [Children-1:0] w_mask, next_mask;
  logic [EnterWidth-1:0] w_next;
  logic [GroupWidth-1:0] kept;
  initial watching = 1'b0;
  initial done = 1'b0;

  assign box_level = levels[3*box_ray+:3];
  assign w_levels  = levels[3*w_ray+:3];
  assign w_own     = w_level < 2'(Depth);
  assign w_next    = w_level[0] ? nexts_1[NextWidth*w_ray+:EnterWidth] : nexts_0[NextWidth*w_ray+:EnterWidth];
  assign next_mask = !w_own ? shared_masks[Children*w_level[0]+:Children]
                   : w_level[0] ? nexts_1[NextWidth*w_ray+EnterWidth+:Children]
                                : nexts_0[NextWidth*w_ray+EnterWidth+:Children];
  assign kept = groups[GroupWidth*(w_own ? {1'b0, w_ray, w_level[0]} : {2'b10, w_level[0]})+:GroupWidth];

  logic asking, leaving;  // asking: the watched node's level is being read; leaving: a node of this level is requested
  logic [Children-1:0] leaving_mask;
  always_ff @(posedge clk) leaving_mask <= mask_q;
  assign asking  = asked_q && asking_ray_q == w_ray && asked_level_q == {1'b0, w_level};
  assign leaving = next_valid_q && next_ray_q == w_ray && next_level_q == {1'b0, w_level};
  assign w_mask  = leaving ? next_remaining_q : next_mask;
  assign present = asking ? mask_q[w_entry] : w_levels > {1'b0, w_level} && w_mask[w_entry];
  assign asked   = leaving && leaving_mask[w_entry]
                   && (leaving_mask & ((Children'(1) << w_entry) - 1'b1)) == '0;
  assign push_here = box && box_inner != '0 && box_ray == w_ray && box_level == {1'b0, w_level};

  always_ff @(posedge clk) begin
    dropped <= choosing_q && choosing_ray_q == w_ray
               && (ended_q || cycle || (w_own && ray_core_pkg::is_beyond(enter_of(w_group, w_entry), t_max_q)));
    if (!reset_n) begin
      watching <= 1'b0;
      done <= 1'b0;
    end else begin
      if (!watching && !done && choose && box && box_inner[which] && which < 3'd7) begin
        watching <= 1'b1;
        w_ray <= box_ray;
        w_level <= box_level[1:0];
        w_entry <= which;
        w_group <= box_group;
      end else if (watching && !present) begin
        watching <= 1'b0;
        done <= asked;
      end else if (done && (push_here || (start_fire && start_ray == w_ray))) begin
        done <= 1'b0;
      end
    end
  end

  // away[r]: a node is being requested, or has been requested and has not arrived, for ray r
  logic [Rays-1:0] away, was_refused;
  logic was_released;
  always_comb begin
    for (int unsigned r = 0; r < Rays; r++) begin
      away[r] = wanted[r] || (asked_q && asking_ray_q == 1'(r))
                || ((next_valid_q || next_started_q) && next_ray_q == 1'(r));
    end
  end
  logic shared_last;
  always_ff @(posedge clk) begin
    was_refused <= refused_q;
    shared_last <= shared_q;
  end
  assign was_released = shared_last && !shared_q;

  // ---- Claims

  always_comb begin
    if (reset_n) begin
      assert (push == (box && box_inner != '0));
      if (push) assert (box_level < 3'(Levels));
      if (push && box_level >= 3'(Depth)) assert (shared_q && shared_ray_q == box_ray);
      for (int unsigned r = 0; r < Rays; r++) begin
        if (refused_q[r]) assert (shared_q && shared_ray_q != 1'(r) && traversing[shared_ray_q] && waiting_q[r] && !busy_q[r] && !ready_q[r]);
        if (was_released) assert (!refused_q[r]);
      end
      if (watching) begin
        assert (present || asked || dropped);
        if (present) assert (traversing[w_ray] && !asked);
        if (asked) assert (node && node_ray == w_ray && node_line == line_of(w_group, w_entry));
      end
      if (done) assert (!asked && !present);

      // Invariants
      if (done && !traversing[w_ray]) assert (w_levels == 3'd0);
      if (shared_q) assert (waiting_q[shared_ray_q] && levels[3*shared_ray_q+:3] >= 3'(Depth));
      for (int unsigned r = 0; r < Rays; r++) begin
        assert (3'(busy_q[r]) == 3'(wanted[r]) + 3'(picked_q && ray_q == 1'(r))
                                 + 3'(choosing_q && choosing_ray_q == 1'(r)) + 3'(asked_q && asking_ray_q == 1'(r))
                                 + 3'((next_valid_q || next_started_q) && next_ray_q == 1'(r)));
        if (ready_q[r] && !busy_q[r]) assert (waiting_q[r]);
        if (traversing[r]) begin
          assert (levels[3*r+:3] <= 3'(Levels));
          assert (waiting_q[r] == (levels[3*r+:3] != 3'd0));
          if (levels[3*r+:3] > 3'(Depth) || (away[r] && levels[3*r+:3] == 3'(Depth))) begin
            assert (shared_q && shared_ray_q == 1'(r));
          end
          if (away[r]) assert (levels[3*r+:3] < 3'(Levels));
        end
      end
      assert (!(next_valid_q && next_started_q));
      if (picked_q) assert (waiting_q[ray_q]);
      if (choosing_q) begin
        assert (waiting_q[choosing_ray_q] && level_q == levels[3*choosing_ray_q+:3]);
        if (level_q > 3'(Depth)) assert (shared_mask_q == shared_masks[Children*(level_q-3)+:Children]);
        assert (next_q_0 == nexts_0[NextWidth*choosing_ray_q+:NextWidth]
                && next_q_1 == nexts_1[NextWidth*choosing_ray_q+:NextWidth]);
      end
      if (asked_q) begin
        assert (asked_level_q < 3'(Levels) && levels[3*asking_ray_q+:3] == asked_level_q + 3'(remaining_q != '0));
        assert (remaining_q == (mask_q & (mask_q - 1'b1)));
      end
      if (next_valid_q) begin
        assert (next_level_q < 3'(Levels) && levels[3*next_ray_q+:3] == next_level_q + 3'(next_remaining_q != '0));
        assert (next_remaining_q == (leaving_mask & (leaving_mask - 1'b1)));
      end
      if (next_started_q) assert (levels[3*next_ray_q+:3] == 3'd0);
      if (watching && (present || asked)) begin
        assert (kept == w_group && w_entry < 3'd7 && is_sorted(w_group));
        if (asking) assert (group_q == w_group);
        if (asking) assert (mask_q == next_mask);
        if (leaving) begin
          assert (leaving_mask == next_mask);
          if (asked) assert (base_q + AddressWidth'(offset_q) == line_of(w_group, w_entry));
          if (w_own && next_remaining_q[w_entry]) assert (next_enter_q <= enter_of(w_group, w_entry));
        end
        if (w_own) assert (w_next <= enter_of(w_group, w_entry));
      end

      cover (watching && asked);
      cover (watching && dropped && !asked);
      cover (done && push_here);
      cover (overflow);
      cover (watching && !w_own && asked);
      cover (was_released && was_refused != '0);
    end
  end

endmodule
