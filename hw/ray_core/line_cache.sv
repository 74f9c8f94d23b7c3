// Lines of one kind, nodes or triangles, that were read not long ago.
//
// Lines places, in sets of eight: the lowest bits of a line's number say which set it is kept in. A request that
// hits gives its line in the next clock. One that misses is given a place of its set, and its line is asked for;
// it enlists for that line, as do all others that want it before it has come: it is read once. Where every place of
// a set waits for another line, a request waits, too. Of the lines of a set one that was not the last to be used
// is given up: its ways take turns, from the one after that.
//
// A request with wanted_i low is for a line that may soon be wanted: nobody enlists. It may be withdrawn before
// it is taken; where its set has no place for it, it is taken and forgotten.
//
// A line from memory goes to all that are enlisted for it, one a clock, the latest first: then fill_done_o, and
// the line may go. It is offered until then. Lines leave in any order, one a clock, each with the ray that
// asked; those from memory first, while what hit waits in a queue and requests are looked up as before.
//
// Memory is read only; invalidate_i, while no line is on its way, empties the cache.
module line_cache #(
  parameter int unsigned Lines    = 256,  // a power of two, at least 16
  parameter int unsigned Waiters  = 64,   // that may be enlisted; a power of two
  parameter int unsigned RayWidth = 6,
  parameter int unsigned Width    = ray_core_pkg::LineWidth,  // of what is kept of a line
  localparam int unsigned PlaceWidth = $clog2(Lines),
  localparam int unsigned WaiterWidth = $clog2(Waiters),
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    invalidate_i,
  // what is asked for
  input  logic                    valid_i,
  output logic                    ready_o,
  input  logic                    wanted_i,
  input  logic [RayWidth-1:0]     ray_i,
  input  logic [AddressWidth-1:0] line_number_i,
  // what is not here
  output logic                    miss_valid_o,
  input  logic                    miss_ready_i,
  output logic [PlaceWidth-1:0]   miss_place_o,
  output logic [AddressWidth-1:0] miss_number_o,
  // what comes from memory
  input  logic                    fill_i,
  output logic                    fill_done_o,
  input  logic [PlaceWidth-1:0]   fill_place_i,
  input  logic [Width-1:0]        fill_line_i,
  // lines
  output logic                    valid_o,
  input  logic                    ready_i,  // else nothing leaves, and fill_i must be low
  output logic [RayWidth-1:0]     ray_o,
  output logic [Width-1:0]        line_o
);

  localparam int unsigned Ways = 8;
  localparam int unsigned WayWidth = $clog2(Ways);
  localparam int unsigned Sets = Lines / Ways;
  localparam int unsigned SetWidth = PlaceWidth - WayWidth;
  localparam int unsigned LabelWidth = AddressWidth - SetWidth;

  logic [Width-1:0] words[Lines];  // by place, {set, way}
  logic [Lines-1:0] held_q, pending_q;  // the line is here, or on its way
  logic [Ways*LabelWidth-1:0] labels[Sets];  // the other bits of its number
  logic [WayWidth-1:0] turns[Sets];  // the way after the one that was used last

  // ---- Look up

  logic [SetWidth-1:0] set;
  logic [LabelWidth-1:0] label;
  logic [Ways*LabelWidth-1:0] set_labels, new_labels;
  logic [Ways-1:0] pending, hits, follows;
  logic [WayWidth-1:0] way, free_way;
  logic [PlaceWidth-1:0] place;
  logic hit, follow, some_place, allocate;

  assign {label, set} = line_number_i;
  assign set_labels   = labels[set];
  assign pending      = pending_q[Ways*set +: Ways];

  for (genvar w = 0; w < Ways; w++) begin : gen_way
    logic same;
    assign same       = set_labels[LabelWidth*w +: LabelWidth] == label;
    assign hits[w]    = same & held_q[{set, WayWidth'(w)}];
    assign follows[w] = same & pending[w];
    assign new_labels[LabelWidth*w +: LabelWidth] =
        (way == WayWidth'(w)) ? label : set_labels[LabelWidth*w +: LabelWidth];
  end

  rotating_pick #(
    .Width(Ways)
  ) u_place (
    .requests_i(~pending),
    .start_i(turns[set]),
    .valid_o(some_place),
    .index_o(free_way)
  );

  assign hit    = hits != '0;
  assign follow = follows != '0;
  assign place  = {set, way};

  always_comb begin
    way = (hit | follow) ? '0 : free_way;
    for (int unsigned w = 0; w < Ways; w++) begin
      if (hits[w] | follows[w]) way = way | WayWidth'(w);
    end
  end

  always_ff @(posedge clk_i) begin
    if (valid_i && ready_o) turns[set] <= way + 1'b1;
    if (allocate) labels[set] <= new_labels;
  end

  // ---- Enlist

  logic [Waiters-1:0] free_q;
  logic [Waiters-1:0] follows_q;  // somebody enlisted before, for the same line
  logic [WaiterWidth-1:0] waiter, current, current_q;
  logic [WaiterWidth-1:0] nexts[Waiters];  // who that was
  logic [WaiterWidth:0] heads[Lines];  // {somebody is enlisted, who enlisted last}
  logic [WaiterWidth:0] head, fill_head;
  logic [RayWidth-1:0] rays[Waiters];
  logic some_free, enlist, arrive, draining_q, somebody, more;
  logic room;  // for one more hit, below

  rotating_pick #(
    .Width(Waiters)
  ) u_pick (
    .requests_i(free_q),
    .start_i('0),
    .valid_o(some_free),
    .index_o(waiter)
  );

  always_comb begin
    if (hit) ready_o = room | ~wanted_i;
    else if (follow) ready_o = ~wanted_i | (some_free & ~(arrive & fill_place_i == place));
    else if (some_place) ready_o = miss_ready_i & (some_free | ~wanted_i);
    else ready_o = ~wanted_i;
  end

  assign miss_valid_o  = valid_i & ~hit & ~follow & some_place & (some_free | ~wanted_i);
  assign miss_place_o  = place;
  assign miss_number_o = line_number_i;
  assign allocate      = miss_valid_o & miss_ready_i;
  assign enlist        = valid_i & ready_o & wanted_i & ~hit;
  assign head          = heads[place];

  always_ff @(posedge clk_i) begin
    if (enlist) begin
      rays[waiter]  <= ray_i;
      nexts[waiter] <= head[WaiterWidth-1:0];
    end
    if (enlist || allocate) heads[place] <= {wanted_i, waiter};
  end

  // ---- A line comes, and goes to all that are enlisted

  assign arrive      = fill_i & ~draining_q;
  assign fill_head   = heads[fill_place_i];
  assign somebody    = draining_q | fill_head[WaiterWidth];
  assign current     = draining_q ? current_q : fill_head[WaiterWidth-1:0];
  assign more        = somebody & follows_q[current];
  assign fill_done_o = fill_i & ~more;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      held_q     <= '0;
      pending_q  <= '0;
      free_q     <= '1;
      follows_q  <= '0;
      draining_q <= 1'b0;
    end else begin
      if (arrive) begin
        held_q[fill_place_i]    <= 1'b1;
        pending_q[fill_place_i] <= 1'b0;
      end
      if (allocate) begin
        held_q[place]    <= 1'b0;
        pending_q[place] <= 1'b1;
      end
      if (invalidate_i) held_q <= '0;
      if (fill_i) draining_q <= more;
      if (fill_i && somebody) free_q[current] <= 1'b1;
      if (enlist) begin
        free_q[waiter]    <= 1'b0;
        follows_q[waiter] <= follow & head[WaiterWidth];
      end
    end
  end
  always_ff @(posedge clk_i) begin
    if (fill_i) current_q <= nexts[current];
    if (arrive) words[fill_place_i] <= fill_line_i;
  end

  // ---- What hit waits for a clock in which no line comes from memory

  logic queued, leaves;
  logic [RayWidth-1:0] queued_ray;
  logic [Width-1:0] queued_line;

  fifo #(
    .Width(RayWidth + Width),
    .Depth(16)
  ) u_hits (
    .clk_i,
    .rst_ni,
    .push_i(valid_i & wanted_i & hit & room),
    .data_i({ray_i, words[place]}),
    .space_o(room),
    .pop_i(leaves),
    .valid_o(queued),
    .data_o({queued_ray, queued_line})
  );

  assign leaves  = queued & ready_i & ~fill_i;
  assign valid_o = (fill_i & somebody) | leaves;
  assign ray_o   = fill_i ? rays[current] : queued_ray;
  assign line_o  = fill_i ? fill_line_i : queued_line;

endmodule
