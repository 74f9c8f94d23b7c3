// Where rays stand in the tree: a short stack for each, and which one goes to its next node.
//
// A stack holds groups of children that a ray enters, the nearest last; of a group those that wait. Each
// clock one ray is picked that neither waits for a node nor has leaves that nobody has asked for: its
// nearest inner node is asked for, or, where that is beyond its limit, the whole group dropped. Rays that have
// no tests on their way come first: what they ask for is needed as far as anybody knows.
//
// Where a stack has no room for a group, the group leaves as a rest: the host sends the ray there. Rests are
// few; while one waits, no node is asked for, so Rays words are room enough.
//
// A node's request is in the queue two clocks after its ray was picked. Rays that start (start_*) ask for
// their first node, and come before those that were picked.
module ray_walk #(
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
  output logic                    start_taken_o,
  // what box_unit says of a node
  input  logic                    box_valid_i,
  input  logic [RayWidth-1:0]     box_ray_i,
  input  logic [GroupWidth-1:0]   box_group_i,
  input  logic [Children-1:0]     box_inner_i,
  // what is known of rays
  input  logic [Rays-1:0]         held_i,      // has leaves to be asked for
  input  logic [Rays-1:0]         testing_i,   // has tests on their way
  output logic [RayWidth-1:0]     limit_ray_o,
  input  logic [30:0]             limit_i,     // of limit_ray_o, in the same clock
  input  logic                    ended_i,     // of limit_ray_o: it needs nothing any more
  output logic [Rays-1:0]         walking_o,   // waits for a node, or has some on its stack
  // nodes asked for; as many as there are rays at most
  output logic                    node_valid_o,
  output logic [RayWidth-1:0]     node_ray_o,
  output logic [AddressWidth-1:0] node_line_o,
  // rests
  output logic                    rest_valid_o,
  output logic [RayWidth-1:0]     rest_ray_o,
  output logic [AddressWidth-1:0] rest_line_o,
  output logic [NodesWidth-1:0]   rest_nodes_o,
  input  logic                    rest_taken_i
);

  localparam int unsigned EntryWidth = ray_core_pkg::EntryWidth;
  localparam int unsigned OffsetWidth = ray_core_pkg::OffsetWidth;
  localparam int unsigned CountWidth = ray_core_pkg::CountWidth;
  localparam int unsigned EnterWidth = ray_core_pkg::EnterWidth;
  localparam int unsigned LevelWidth = $clog2(Depth + 1);
  localparam int unsigned PlaceWidth = $clog2(Rays * Depth);

  logic [GroupWidth-1:0] groups[Rays*Depth];
  logic [Children-1:0] masks[Rays*Depth];  // which entries wait
  logic [LevelWidth-1:0] levels[Rays];     // groups on the stack
  logic [Rays-1:0] busy_q;     // waits for a node
  logic [Rays-1:0] waiting_q;  // levels is not 0

  assign walking_o = busy_q | waiting_q;

  function automatic logic [PlaceWidth-1:0] place(logic [RayWidth-1:0] slot,
                                                  logic [LevelWidth-1:0] depth);
    place = PlaceWidth'(slot) * PlaceWidth'(Depth) + PlaceWidth'(depth);
  endfunction

  // ---- Pick

  logic [Rays-1:0] ready, sure;
  logic some, pick, picked_q;
  logic [RayWidth-1:0] picked_ray, ray_q;

  assign ready = waiting_q & ~busy_q & ~held_i;
  assign sure  = ready & ~testing_i;
  assign pick  = some & ~start_valid_i & ~rest_valid_o;

  rotating_pick #(
    .Width(Rays)
  ) u_pick (
    .requests_i((sure != '0) ? sure : ready),
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

  // ---- Take the nearest of the group on top

  logic [LevelWidth-1:0] level, below;
  logic [GroupWidth-1:0] group;
  logic [Children-1:0] mask, lowest, rest;
  logic [EnterWidth+OffsetWidth-1:0] entry;
  logic beyond, go, last;

  assign level       = levels[ray_q];
  assign below       = level - 1'b1;
  assign group       = groups[place(ray_q, below)];
  assign mask        = masks[place(ray_q, below)];
  assign lowest      = mask & -mask;
  assign rest        = mask & ~lowest;
  assign limit_ray_o = ray_q;

  always_comb begin
    entry = '0;
    for (int unsigned n = 0; n < Children; n++) begin
      if (lowest[n]) entry = group[EntryWidth*n+CountWidth+:EnterWidth+OffsetWidth];
    end
  end

  assign beyond = ended_i | ray_core_pkg::is_beyond(
      group[Children*EntryWidth +: ray_core_pkg::ExponentWidth],
      entry[OffsetWidth +: EnterWidth], limit_i);
  assign go   = picked_q & ~beyond;
  assign last = beyond | (rest == '0);  // of the group

  assign start_taken_o = start_valid_i & ~picked_q & ~rest_valid_o;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) node_valid_o <= 1'b0;
    else node_valid_o <= go | start_taken_o;
  end
  always_ff @(posedge clk_i) begin
    node_ray_o  <= picked_q ? ray_q : start_ray_i;
    node_line_o <= picked_q
        ? group[GroupWidth-1 -: AddressWidth] + AddressWidth'(entry[OffsetWidth-1:0])
        : start_line_i;
  end

  // ---- Push what box_unit found

  logic push, room;
  logic [LevelWidth-1:0] box_level;

  assign box_level = levels[box_ray_i];
  assign room      = box_level != LevelWidth'(Depth);
  assign push      = box_valid_i & (box_inner_i != '0) & room;

  always_ff @(posedge clk_i) begin
    if (push) groups[place(box_ray_i, box_level)] <= box_group_i;
  end

  // ---- State; a ray is picked, starts, or hears of a node, never two of these at once

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      busy_q    <= '0;
      waiting_q <= '0;
    end else begin
      if (pick) busy_q[picked_ray] <= 1'b1;
      if (start_taken_o) busy_q[start_ray_i] <= 1'b1;
      if (picked_q && beyond) busy_q[ray_q] <= 1'b0;
      if (box_valid_i) busy_q[box_ray_i] <= 1'b0;
      if (picked_q && last) waiting_q[ray_q] <= ~ended_i & (below != '0);
      if (push) waiting_q[box_ray_i] <= 1'b1;
    end
  end
  always_ff @(posedge clk_i) begin
    if (start_taken_o) levels[start_ray_i] <= '0;
    if (picked_q && last) levels[ray_q] <= ended_i ? '0 : below;
    if (push) levels[box_ray_i] <= box_level + 1'b1;
    if (picked_q && !last) masks[place(ray_q, below)] <= rest;
    if (push) masks[place(box_ray_i, box_level)] <= box_inner_i;
  end

  // ---- Rests

  logic [NodesWidth-1:0] nodes;
  logic unused_space;

  always_comb begin
    nodes = '0;
    for (int unsigned n = 0; n < Children; n++) begin
      if (box_inner_i[n]) nodes[box_group_i[EntryWidth*n+CountWidth+:OffsetWidth]] = 1'b1;
    end
  end

  fifo #(
    .Width(RayWidth + AddressWidth + NodesWidth),
    .Depth(Rays)
  ) u_rests (
    .clk_i,
    .rst_ni,
    .push_i(box_valid_i & (box_inner_i != '0) & ~room),
    .data_i({box_ray_i, box_group_i[GroupWidth-1 -: AddressWidth], nodes}),
    .space_o(unused_space),
    .pop_i(rest_taken_i),
    .valid_o(rest_valid_o),
    .data_o({rest_ray_o, rest_line_o, rest_nodes_o})
  );

endmodule
