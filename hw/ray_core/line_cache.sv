// Non-blocking cache of memory lines of one kind, nodes or triangles: eight ways, read only.
//
// The lowest bits of a line's number are its set. A hit gives its line in the next clock. A miss takes a way of its
// set and asks memory for the line; every request for that line, until it has come, waits as a target of the one
// miss. Where all ways of a set wait for other lines, the request waits. The victim of a set is the next way after
// the one that was used last.
//
// A prefetch is a request with demand_i low: it has no target. It may be withdrawn before it is taken; where its
// set has no way for it, it is taken and forgotten.
//
// A line from memory goes to all targets, one a clock, the latest first; then fill_done_o, and the line, offered
// until then, may go. Lines leave in any order, one a clock, each with the ray that asked; those from memory
// first, while hits wait in a queue and requests are looked up as before.
//
// A line that comes with an error goes to its targets, error_o, and is not kept.
//
// invalidate_i, while no line is outstanding, empties the cache.
module line_cache #(
  parameter int unsigned Lines    = 256,  // a power of two, at least 16
  parameter int unsigned Targets  = 64,   // requests that may wait for lines, at least 2
  parameter int unsigned RayWidth = 6,
  parameter int unsigned Width    = ray_core_pkg::LineWidth,  // of what is kept of a line
  localparam int unsigned EntryWidth = $clog2(Lines),
  localparam int unsigned TargetWidth = $clog2(Targets),
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    invalidate_i,
  // requests
  input  logic                    valid_i,
  output logic                    ready_o,
  input  logic                    demand_i,
  input  logic [RayWidth-1:0]     ray_i,
  input  logic [AddressWidth-1:0] line_number_i,
  // misses
  output logic                    miss_valid_o,
  input  logic                    miss_ready_i,
  output logic [EntryWidth-1:0]   miss_entry_o,
  output logic [AddressWidth-1:0] miss_number_o,
  // lines from memory
  input  logic                    fill_i,
  output logic                    fill_done_o,
  input  logic [EntryWidth-1:0]   fill_entry_i,
  input  logic [Width-1:0]        fill_line_i,
  input  logic                    fill_error_i,
  // answers
  output logic                    valid_o,
  input  logic                    ready_i,  // else nothing leaves, and fill_i must be low
  output logic [RayWidth-1:0]     ray_o,
  output logic [Width-1:0]        line_o,
  output logic                    error_o
);

  localparam int unsigned Ways = 8;
  localparam int unsigned WayWidth = $clog2(Ways);
  localparam int unsigned Sets = Lines / Ways;
  localparam int unsigned SetWidth = EntryWidth - WayWidth;
  localparam int unsigned TagWidth = AddressWidth - SetWidth;

  if (Lines < 2 * Ways || 2 ** EntryWidth != Lines) begin : gen_check
    $error("line_cache: expected Lines to be a power of two, at least 16");
  end

  logic [Width-1:0] words[Lines];  // by entry, {set, way}
  logic [Lines-1:0] valid_q, pending_q;  // the line is here, or on its way
  logic [Ways*TagWidth-1:0] tags[Sets];  // the other bits of its number
  logic [Sets*WayWidth-1:0] victims_q;  // of each set the way after the one that was used last

  // ---- Look up

  logic [SetWidth-1:0] set;
  logic [TagWidth-1:0] tag;
  logic [Ways*TagWidth-1:0] set_tags, new_tags;
  logic [Ways-1:0] pending, hits, follows;
  logic [WayWidth-1:0] way, victim_way;
  logic [EntryWidth-1:0] entry;
  logic hit, follow, some_way, allocate;

  assign {tag, set} = line_number_i;
  assign set_tags   = tags[set];
  assign pending    = pending_q[Ways*set +: Ways];

  for (genvar w = 0; w < Ways; w++) begin : gen_way
    logic same;
    assign same       = set_tags[TagWidth*w +: TagWidth] == tag;
    assign hits[w]    = same & valid_q[{set, WayWidth'(w)}];
    assign follows[w] = same & pending[w];
    assign new_tags[TagWidth*w +: TagWidth] =
        (way == WayWidth'(w)) ? tag : set_tags[TagWidth*w +: TagWidth];
  end

  rr_arbiter #(
    .Width(Ways)
  ) u_victim (
    .requests_i(~pending),
    .start_i(victims_q[WayWidth*set +: WayWidth]),
    .valid_o(some_way),
    .index_o(victim_way)
  );

  assign hit    = hits != '0;
  assign follow = follows != '0;
  assign entry  = {set, way};

  always_comb begin
    way = (hit | follow) ? '0 : victim_way;
    for (int unsigned w = 0; w < Ways; w++) begin
      if (hits[w] | follows[w]) way = way | WayWidth'(w);
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) victims_q <= '0;
    else if (valid_i && ready_o) victims_q[WayWidth*set+:WayWidth] <= way + 1'b1;
  end
  always_ff @(posedge clk_i) if (allocate) tags[set] <= new_tags;

  // ---- Targets: lists of requests that wait, one for each entry

  logic [Targets-1:0] free_q;
  logic [Targets-1:0] follows_q;  // another target of the same line came before
  logic [TargetWidth-1:0] target, current, current_q;
  logic [TargetWidth-1:0] nexts[Targets];  // which that was
  logic [TargetWidth:0] heads[Lines];  // {there is one, the latest}
  logic [TargetWidth:0] head, fill_head;
  logic [RayWidth-1:0] rays[Targets];
  logic some_free, add_target, arrive, draining_q, somebody, more;
  logic room;  // for one more hit, below

  rr_arbiter #(
    .Width(Targets)
  ) u_pick (
    .requests_i(free_q),
    .start_i('0),
    .valid_o(some_free),
    .index_o(target)
  );

  always_comb begin
    if (hit) ready_o = room | ~demand_i;
    else if (follow) ready_o = ~demand_i | (some_free & ~(arrive & fill_entry_i == entry));
    else if (some_way) ready_o = miss_ready_i & (some_free | ~demand_i);
    else ready_o = ~demand_i;
  end

  assign miss_valid_o  = valid_i & ~hit & ~follow & some_way & (some_free | ~demand_i);
  assign miss_entry_o  = entry;
  assign miss_number_o = line_number_i;
  assign allocate      = miss_valid_o & miss_ready_i;
  assign add_target    = valid_i & ready_o & demand_i & ~hit;
  assign head          = heads[entry];

  always_ff @(posedge clk_i) begin
    if (add_target) begin
      rays[target]  <= ray_i;
      nexts[target] <= head[TargetWidth-1:0];
    end
    if (add_target || allocate) heads[entry] <= {demand_i, target};
  end

  // ---- A line comes, and goes to all its targets

  assign arrive      = fill_i & ~draining_q;
  assign fill_head   = heads[fill_entry_i];
  assign somebody    = draining_q | fill_head[TargetWidth];
  assign current     = draining_q ? current_q : fill_head[TargetWidth-1:0];
  assign more        = somebody & follows_q[current];
  assign fill_done_o = fill_i & ~more;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_q    <= '0;
      pending_q  <= '0;
      free_q     <= '1;
      follows_q  <= '0;
      draining_q <= 1'b0;
    end else begin
      if (arrive) begin
        valid_q[fill_entry_i]   <= ~fill_error_i;
        pending_q[fill_entry_i] <= 1'b0;
      end
      if (allocate) begin
        valid_q[entry]   <= 1'b0;
        pending_q[entry] <= 1'b1;
      end
      if (invalidate_i) valid_q <= '0;
      if (fill_i) draining_q <= more;
      if (fill_i && somebody) free_q[current] <= 1'b1;
      if (add_target) begin
        free_q[target]    <= 1'b0;
        follows_q[target] <= follow & head[TargetWidth];
      end
    end
  end
  always_ff @(posedge clk_i) begin
    if (fill_i) current_q <= nexts[current];
    if (arrive) words[fill_entry_i] <= fill_line_i;
  end

  // ---- Hits wait for a clock in which no line comes from memory

  logic queued, leaves;
  logic [RayWidth-1:0] queued_ray;
  logic [Width-1:0] queued_line;

  fifo #(
    .Width(RayWidth + Width),
    .Depth(16)
  ) u_hits (
    .clk_i,
    .rst_ni,
    .push_i(valid_i & demand_i & hit & room),
    .data_i({ray_i, words[entry]}),
    .space_o(room),
    .pop_i(leaves),
    .valid_o(queued),
    .data_o({queued_ray, queued_line})
  );

  assign leaves  = queued & ready_i & ~fill_i;
  assign valid_o = (fill_i & somebody) | leaves;
  assign ray_o   = fill_i ? rays[current] : queued_ray;
  assign line_o  = fill_i ? fill_line_i : queued_line;
  assign error_o = fill_i & fill_error_i;

endmodule
