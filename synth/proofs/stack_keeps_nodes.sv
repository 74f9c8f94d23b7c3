// A ray's stack, whatever box_unit says, whichever rays wait, from reset and for ever: a node that was pushed is
// asked for, once, by the line that its group gives, unless it was beyond the ray's t_max, or the ray had ended or met a node again, in
// a clock in which its stack was looked at; until then the ray counts as traversing. A group without room, and no other, goes
// into the queue of overflows, with its ray's tag, its line and the mask of its nodes, and the queue has room for it (that it keeps
// order is ram_fifo_keeps_order's). No more nodes wait than there are rays.
// opened_traversal is traversal of two rays, with stacks of two groups, with its registers and memories as outputs.
module stack_keeps_nodes #(
  localparam int unsigned Rays  = 2,
  localparam int unsigned Depth = 2,
  localparam int unsigned Children = ray_core_pkg::Children,
  localparam int unsigned GroupWidth = ray_core_pkg::GroupWidth,
  localparam int unsigned EntryWidth = ray_core_pkg::EntryWidth,
  localparam int unsigned EnterWidth = ray_core_pkg::EnterWidth,
  localparam int unsigned OffsetWidth = ray_core_pkg::OffsetWidth,
  localparam int unsigned CountWidth = ray_core_pkg::CountWidth,
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth,
  localparam int unsigned NodesWidth = ray_core_pkg::NodesWidth,
  localparam int unsigned OverflowWidth = 32 + AddressWidth + NodesWidth,
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
  input logic                  overflow_fire,
  input logic                  choose,  // the child `which` of the group pushed now is the one that is watched
  input logic [2:0]            which
);

  logic reset_n;  // low for the first clock
  initial reset_n = 1'b0;
  always_ff @(posedge clk) reset_n <= 1'b1;

  (* anyseq *) logic [AddressWidth-1:0] start_line;
  (* anyconst *) logic [AddressWidth-1:0] lines;
  (* anyseq *) logic [GroupWidth-1:0] box_group;
  (* anyseq *) logic [31:0] box_tag;

  logic start_fire, node, node_ray, overflow, cycle;
  logic [OverflowWidth-1:0] overflow_word, pushed;
  logic push_overflow;
  logic [2:0] overflows;  // in the queue
  logic t_max_ray;
  logic [AddressWidth-1:0] node_line;
  logic [Rays-1:0] traversing, busy_q, waiting_q;
  // Of each stage whether it has a ray that was picked, or one that starts, and which
  logic picked_q, ray_q, choosing_q, choosing_ray_q, asked_q, asking_ray_q;
  logic next_valid_q, next_started_q, next_ray_q;
  logic [Rays-1:0] ready_q;
  logic ended_q;
  logic [30:0] t_max_q;
  logic [1:0] level_q, asked_level_q, next_level_q;
  logic [Children-1:0] mask_q, remaining_q, next_remaining_q;
  logic [EnterWidth-1:0] next_enter_q;
  logic [AddressWidth-1:0] base_q;
  logic [OffsetWidth-1:0] offset_q;
  logic [Rays*2-1:0] levels;
  logic [NextWidth-1:0] next_q_0, next_q_1;
  logic [Rays*NextWidth-1:0] nexts_0, nexts_1;
  logic [Rays*Depth*GroupWidth-1:0] groups;
  logic [GroupWidth-1:0] group_q;  // of the level that is asked

  opened_traversal dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .start_valid_i(start),
    .start_ray_i(start_ray),
    .start_line_i(start_line),
    .start_fire_o(start_fire),
    .box_valid_i(box),
    .box_ray_i(box_ray),
    .box_tag_i(box_tag),
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
    .overflow_o({overflow, overflow_word}),
    .overflow_fire_i(overflow_fire),
    .\u_overflows.push_i (push_overflow),
    .\u_overflows.data_i (pushed),
    .\u_overflows.count_q (overflows),
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

  // ---- What the user promises: rays begin that do not walk, nodes come that were asked for, near ones first

  logic [Rays-1:0] wanted;  // nodes asked for that have not come

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
      assume (!overflow_fire || overflow);
    end else begin
      assume (!start && !box && !overflow_fire);
    end
  end

  // ---- The watched node

  logic watching, done, w_ray, w_level, dropped;
  logic [2:0] w_entry;
  logic [GroupWidth-1:0] w_group;
  logic [1:0] box_level, w_levels;
  logic asked, present, push_here;
  logic [Children-1:0] w_mask, next_mask;
  logic [EnterWidth-1:0] w_next;
  logic [GroupWidth-1:0] kept;
  initial watching = 1'b0;
  initial done = 1'b0;

  assign box_level = levels[2*box_ray+:2];
  assign w_levels  = levels[2*w_ray+:2];
  assign {next_mask, w_next} = w_level ? nexts_1[NextWidth*w_ray+:NextWidth]
                                       : nexts_0[NextWidth*w_ray+:NextWidth];
  assign kept = groups[GroupWidth*{w_ray, w_level}+:GroupWidth];

  logic asking, leaving;  // its group's level is being asked, and its node leaves
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
               && (ended_q || cycle || ray_core_pkg::is_beyond(enter_of(w_group, w_entry), t_max_q));
    if (!reset_n) begin
      watching <= 1'b0;
      done <= 1'b0;
    end else begin
      if (!watching && !done && choose && box && box_inner[which] && which < 3'd7
          && box_level < 2'd2) begin
        watching <= 1'b1;
        w_ray <= box_ray;
        w_level <= box_level[0];
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

  // The nodes of box_group that box_inner has, by their offsets
  logic [NodesWidth-1:0] inner_nodes;
  always_comb begin
    inner_nodes = '0;
    for (int unsigned n = 0; n < Children; n++) begin
      if (box_inner[n]) inner_nodes = inner_nodes | NodesWidth'(1) << box_group[EntryWidth*n+CountWidth+:OffsetWidth];
    end
  end

  // ---- Claims

  always_comb begin
    if (reset_n) begin
      assert (push_overflow == (box && box_inner != '0 && box_level == 2'(Depth)));
      if (push_overflow) begin
        assert (pushed == {box_tag, box_group[GroupWidth-1-:AddressWidth], inner_nodes});
        assert (overflows < 3'(Rays + 2));
      end
      if (watching) begin
        assert (present || asked || dropped);
        if (present) assert (traversing[w_ray] && !asked);
        if (asked) assert (node && node_ray == w_ray && node_line == line_of(w_group, w_entry));
      end
      if (done) assert (!asked && !present);

      // Invariants
      assert (overflow ? overflows != '0 : overflows <= 3'd1);
      assert (5'(overflows) + 5'(busy_q[0]) + 5'(busy_q[1]) <= 5'(Rays + 1));
      for (int unsigned r = 0; r < Rays; r++) begin
        assert (3'(busy_q[r]) == 3'(wanted[r]) + 3'(picked_q && ray_q == 1'(r))
                                 + 3'(choosing_q && choosing_ray_q == 1'(r)) + 3'(asked_q && asking_ray_q == 1'(r))
                                 + 3'((next_valid_q || next_started_q) && next_ray_q == 1'(r)));
        if (ready_q[r] && !busy_q[r]) assert (waiting_q[r]);
        if (traversing[r]) begin
          assert (levels[2*r+:2] <= 2'd2);
          assert (waiting_q[r] == (levels[2*r+:2] != 2'd0));
        end
      end
      assert (!(next_valid_q && next_started_q));
      if (picked_q) assert (waiting_q[ray_q]);
      if (choosing_q) begin
        assert (waiting_q[choosing_ray_q] && level_q == levels[2*choosing_ray_q+:2]);
        assert (next_q_0 == nexts_0[NextWidth*choosing_ray_q+:NextWidth]
                && next_q_1 == nexts_1[NextWidth*choosing_ray_q+:NextWidth]);
      end
      if (asked_q) begin
        assert (levels[2*asking_ray_q+:2] == asked_level_q + 2'(remaining_q != '0));
        assert (remaining_q == (mask_q & (mask_q - 1'b1)));
      end
      if (next_valid_q) begin
        assert (levels[2*next_ray_q+:2] == next_level_q + 2'(next_remaining_q != '0));
        assert (next_remaining_q == (leaving_mask & (leaving_mask - 1'b1)));
      end
      if (next_started_q) assert (levels[2*next_ray_q+:2] == 2'd0);
      if (watching && (present || asked)) begin
        assert (kept == w_group && w_entry < 3'd7 && is_sorted(w_group));
        if (asking) assert (group_q == w_group);
        if (asking) assert (mask_q == next_mask);
        if (leaving) begin
          assert (leaving_mask == next_mask);
          if (asked) assert (base_q + AddressWidth'(offset_q) == line_of(w_group, w_entry));
          if (next_remaining_q[w_entry]) assert (next_enter_q <= enter_of(w_group, w_entry));
        end
        assert (w_next <= enter_of(w_group, w_entry));
      end

      cover (watching && asked);
      cover (watching && dropped && !asked);
      cover (done && push_here);
      cover (push_overflow);
    end
  end

endmodule
