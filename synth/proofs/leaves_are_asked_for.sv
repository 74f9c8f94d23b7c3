// Claims, from reset on, for any groups of leaves that rays enter: primitive_fetch requests the triangles of a group in
// order, near leaves first, each once, by the line numbers in the group. A triangle is dropped without a request only
// in a clock in which its leaf is beyond the ray's t_max, or the ray has ended. A ray is leaf_pending until all
// triangles of its group are requested or dropped. The queue of groups does not overflow. opened_primitive_fetch is
// primitive_fetch of two rays with its registers and its queue as outputs.
module leaves_are_asked_for #(
  localparam int unsigned Rays = 2,
  localparam int unsigned Children = ray_core_pkg::Children,
  localparam int unsigned GroupWidth = ray_core_pkg::GroupWidth,
  localparam int unsigned EntryWidth = ray_core_pkg::ChildWidth,
  localparam int unsigned EnterWidth = ray_core_pkg::EnterWidth,
  localparam int unsigned OffsetWidth = ray_core_pkg::OffsetWidth,
  localparam int unsigned CountWidth = ray_core_pkg::LeafWidth,
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth,
  localparam int unsigned WordWidth = 1 + GroupWidth + Children,
  localparam int unsigned TotalWidth = 6
) (
  input logic                  clk,
  input logic                  box,
  input logic                  box_ray,
  input logic [Children-1:0]   box_leaf,
  input logic [30:0]           t_max,
  input logic                  ended,
  input logic                  ready,
  input logic                  choose,  // watch triangle `number` of leaf `which` of the group arriving in this clock
  input logic [2:0]            which,
  input logic [CountWidth-1:0] number
);

  logic reset_n;  // low for the first clock
  initial reset_n = 1'b0;
  always_ff @(posedge clk) reset_n <= 1'b1;

  (* anyseq *) logic [GroupWidth-1:0] box_group;

  logic t_max_ray, triangle, triangle_ray, valid_q, ray_q, queued, read_q, write_q;
  logic [AddressWidth-1:0] line;
  logic [Rays-1:0] leaf_pending;
  logic [GroupWidth-1:0] group_q;
  logic [Children-1:0] mask_q;
  logic [CountWidth-1:0] number_q;
  logic [1:0] count;
  logic [Rays*WordWidth-1:0] words;
  logic [WordWidth-1:0] head;

  opened_primitive_fetch dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .box_valid_i(box),
    .box_ray_i(box_ray),
    .box_group_i(box_group),
    .box_leaf_i(box_leaf),
    .t_max_ray_o(t_max_ray),
    .t_max_i(t_max),
    .ended_i(ended),
    .leaf_pending_o(leaf_pending),
    .triangle_ray_o(triangle_ray),
    .triangle_o({triangle, line}),
    .triangle_ready_i(ready),
    .valid_q(valid_q),
    .ray_q(ray_q),
    .group_q(group_q),
    .mask_q(mask_q),
    .number_q(number_q),
    .\u_groups.count_q (count),
    .\u_groups.valid_o (queued),
    .\u_groups.data_o (head),
    .\u_groups.read_q (read_q),
    .\u_groups.write_q (write_q),
    .u_groups_words(words)
  );

  // ---- Entries of a group

  function automatic logic [EnterWidth-1:0] enter_of(logic [GroupWidth-1:0] group, logic [2:0] n);
    enter_of = group[EntryWidth*n+CountWidth+OffsetWidth+:EnterWidth];
  endfunction
  function automatic logic [CountWidth-1:0] count_of(logic [GroupWidth-1:0] group, logic [2:0] n);
    count_of = group[EntryWidth*n+:CountWidth];
  endfunction
  function automatic logic [TotalWidth-1:0] triangles_of(logic [GroupWidth-1:0] group,
                                                         logic [Children-1:0] mask);
    triangles_of = '0;
    for (int unsigned n = 0; n < Children; n++) begin
      if (mask[n]) triangles_of = triangles_of + TotalWidth'(group[EntryWidth*n+:CountWidth]);
    end
  endfunction
  // Returns whether leaves are in order, near leaves first, and no leaf in the mask is empty
  function automatic logic is_group(logic [GroupWidth-1:0] group, logic [Children-1:0] mask);
    is_group = 1'b1;
    for (int unsigned n = 0; n < Children; n++) begin
      if (mask[n] && group[EntryWidth*n+:CountWidth] == '0) is_group = 1'b0;
      if (n + 1 < Children && group[EntryWidth*n+CountWidth+OffsetWidth+:EnterWidth]
                              > group[EntryWidth*(n+1)+CountWidth+OffsetWidth+:EnterWidth]) begin
        is_group = 1'b0;
      end
    end
  endfunction

  // ---- Assumptions about the user: groups are sorted, and a ray that is leaf_pending enters no further group

  always_comb begin
    if (reset_n) assume (!box || box_leaf == '0 || (!leaf_pending[box_ray] && is_group(box_group, box_leaf)));
    else assume (!box);
  end

  // leaves: the current group ends, because its last triangle is requested or because the rest of the group is dropped
  logic leaves, dropped;
  logic [2:0] nearest;
  always_comb begin
    nearest = '0;
    for (int unsigned n = 0; n < Children; n++) begin
      if (mask_q[n] && (mask_q & ((Children'(1) << n) - 1'b1)) == '0) nearest = 3'(n);
    end
  end
  assign dropped = ended || ray_core_pkg::is_beyond(enter_of(group_q, nearest), t_max);
  assign leaves = valid_q && (dropped || (triangle && ready && (mask_q & (mask_q - 1'b1)) == '0
                                          && number_q + 1'b1 == count_of(group_q, nearest)));

  // ---- The watched triangle, and how many triangles of its group were requested

  localparam logic [1:0] Nowhere = 2'd0, Queued = 2'd1, Walked = 2'd2;
  logic [1:0] state;
  logic w_ray, w_place, w_head, given, w_beyond;  // w_head: the watched triangle's group is at the queue's output
  logic load, read;
  logic [GroupWidth-1:0] w_group;
  logic [Children-1:0] w_mask;
  logic [2:0] w_leaf;
  logic [CountWidth-1:0] w_number;
  logic [TotalWidth-1:0] asked, asked_next, rank;
  initial state = Nowhere;

  assign load       = queued && (!valid_q || leaves);
  assign read       = count != 2'(queued) && (!queued || load);
  assign rank       = triangles_of(w_group, w_mask & ((Children'(1) << w_leaf) - 1'b1)) + TotalWidth'(w_number);
  assign given      = state == Walked && triangle && ready;
  assign asked_next = asked + TotalWidth'(given);
  assign w_beyond   = ended || ray_core_pkg::is_beyond(enter_of(w_group, w_leaf), t_max);

  always_ff @(posedge clk) begin
    if (!reset_n) begin
      state <= Nowhere;
    end else begin
      if (state == Nowhere) begin
        if (box && choose && which < 3'd7 && box_leaf[which] && number < count_of(box_group, which)) begin
          state <= Queued;
          w_ray <= box_ray;
          w_group <= box_group;
          w_mask <= box_leaf;
          w_leaf <= which;
          w_number <= number;
          w_place <= write_q;
          w_head <= 1'b0;
          asked <= '0;
        end
      end else if (state == Queued) begin
        if (read && read_q == w_place) w_head <= 1'b1;
        if (load && w_head) state <= Walked;
      end else begin
        asked <= asked_next;
        if (leaves) state <= Nowhere;
      end
    end
  end

  logic asked_before, t_max_before;
  initial asked_before = 1'b0;
  always_ff @(posedge clk) {asked_before, t_max_before} <= {reset_n, t_max_ray};

  // ---- Claims

  logic [WordWidth-1:0] first, second, w_word;  // words of the queue: the first two, and that of the watched triangle
  assign second = read_q ? words[2*WordWidth-1:WordWidth] : words[WordWidth-1:0];
  assign first  = queued ? head : second;
  assign w_word = w_head ? head : w_place ? words[2*WordWidth-1:WordWidth] : words[WordWidth-1:0];

  always_comb begin
    if (reset_n) begin
      assert (triangle_ray == ray_q && (!asked_before || t_max_before == ray_q));
      if (triangle) assert (valid_q);
      if (state != Nowhere) assert (leaf_pending[w_ray]);
      if (given && asked == rank) begin
        assert (triangle_ray == w_ray
                && line == w_group[GroupWidth-1-:AddressWidth]
                           + AddressWidth'(w_group[EntryWidth*w_leaf+CountWidth+:OffsetWidth])
                           + AddressWidth'(w_number));
      end
      if (state == Walked) assert (asked_next <= triangles_of(w_group, w_mask));
      if (state == Walked && leaves && asked_next <= rank) assert (w_beyond);

      // Invariants
      assert (count <= 2'd2);
      if (queued) assert (count != '0);
      if (count == 2'd2) assert (queued);
      assert ((read_q == write_q) == (count == 2'(queued)));
      if (valid_q) assert (leaf_pending[ray_q] && mask_q != '0);
      if (count != '0) assert (leaf_pending[first[WordWidth-1]] && (!valid_q || first[WordWidth-1] != ray_q));
      if (count == 2'd2) assert (!valid_q && leaf_pending[second[WordWidth-1]] && first[WordWidth-1] != second[WordWidth-1]);
      if (count != '0) assert (first[Children-1:0] != '0 && is_group(first[Children+:GroupWidth], first[Children-1:0]));
      if (count == 2'd2) begin
        assert (second[Children-1:0] != '0 && is_group(second[Children+:GroupWidth], second[Children-1:0]));
      end
      if (valid_q) assert (is_group(group_q, mask_q) && number_q < count_of(group_q, nearest));
      if (state != Nowhere) begin
        assert (w_leaf < 3'd7 && w_mask[w_leaf] && w_number < count_of(w_group, w_leaf) && is_group(w_group, w_mask));
      end
      if (state == Queued) begin
        assert (asked == '0 && w_word == {w_ray, w_group, w_mask});
        assert (w_head ? queued : count != 2'(queued) && read_q == w_place);
      end
      if (state == Walked) begin
        assert (valid_q && ray_q == w_ray && group_q == w_group);
        assert ((mask_q & ~w_mask) == '0 && (w_mask & ~mask_q) < (mask_q & -mask_q));
        assert (asked == triangles_of(w_group, w_mask & ~mask_q) + TotalWidth'(number_q));
      end

      cover (given && asked == rank && rank > TotalWidth'(3));
      cover (state == Walked && leaves && asked_next <= rank && asked != '0);
      cover (state == Queued && valid_q && triangle);
    end
  end

endmodule
