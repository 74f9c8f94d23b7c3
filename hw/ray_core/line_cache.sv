// Non-blocking cache of memory lines of one kind, nodes or triangles: eight ways, read only.
//
// The lowest bits of a line's number select its set. A miss requests the line from memory and takes a way of its set
// that waits for no line: the first after the way that was used last. Until the line comes, further requests for it
// wait with the first, as its targets. If all ways of the set wait for other lines, the request waits.
//
//   ask      a request is taken; the tags of its set are read
//   compare  these tags are compared with the tag of the requested line
//   look up  a hit's line is read, a miss asks memory
//   queue    hits wait for a clock in which no line from memory leaves
//
// A prefetch is a request with demand_i low: it has no target. It may be withdrawn before it is taken, and is dropped
// if its set has no way for it or memory takes no request. outstanding_o: a prefetch is being looked up.
//
// A line from memory is taken when the previous line has gone to its last target, or goes there now. It is written to
// the cache. From the next clock on it goes to its targets, one per clock, the latest first. Meanwhile hits wait in
// their queue, but requests are still looked up. A line with an error goes to its targets with
// error_o, and is not kept. Lines leave in any order, each with the ray that asked. Throughput: a line a clock.
// Latency: 5 for a hit (clocks from its request to its line, if the queue is empty and no line from memory leaves).
//
// invalidate_i empties the cache; no request and no line may be in flight then.
module line_cache
  import ray_core_pkg::*;
#(
  parameter int unsigned Lines    = 256,
  parameter int unsigned Targets  = 64,   // number of requests that may wait for lines
  parameter int unsigned RayWidth = 6,
  parameter int unsigned Width    = LineWidth,  // bits kept of a line
  localparam int unsigned EntryWidth = $clog2(Lines),
  localparam int unsigned TargetWidth = $clog2(Targets)
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
  output logic                    outstanding_o,
  // misses
  output logic                    miss_valid_o,
  input  logic                    miss_ready_i,
  output logic [EntryWidth-1:0]   miss_entry_o,
  output logic [AddressWidth-1:0] miss_number_o,
  // lines from memory
  input  logic                    fill_i,
  output logic                    fill_ready_o,
  input  logic [EntryWidth-1:0]   fill_entry_i,
  input  logic [Width-1:0]        fill_line_i,
  input  logic                    fill_error_i,
  // answers
  output logic                    valid_o,
  input  logic                    ready_i,  // if it is low, no line leaves
  output logic [RayWidth-1:0]     ray_o,
  output logic [Width-1:0]        line_o,
  output logic                    error_o
);

  localparam int unsigned Ways = 8;
  localparam int unsigned WayWidth = $clog2(Ways);
  localparam int unsigned Sets = Lines / Ways;
  localparam int unsigned SetWidth = EntryWidth - WayWidth;
  localparam int unsigned TagWidth = AddressWidth - SetWidth;

  if (Lines < 16 || 2 ** EntryWidth != Lines || Targets < 2) begin : gen_check
    $error("line_cache: expected Lines of 16 or more, a power of two, and Targets of 2 or more");
  end

  logic [Lines-1:0] valid_q, pending_q;  // the entry's line is here; the line is requested
  logic [Sets-1:0][WayWidth-1:0] victims_q;  // by set: the way after the one that was used last

  // ---- Ask

  logic ask, compare_q, compare_demand_q, request_q, demand_q, go;
  logic done;  // the request that is looked up leaves
  logic allocate, changed_q;
  logic [RayWidth-1:0] compare_ray_q, ray_q;
  logic [SetWidth-1:0] asked_set, compare_set_q, set;
  logic [TagWidth-1:0] asked_tag, compare_tag_q, changed_tag_q, tag;
  logic [Ways-1:0][TagWidth-1:0] set_tags;  // by way: the other bits of the line's number
  logic [WayWidth-1:0] changed_way_q, way, start_q, victim_way;
  logic [Ways-1:0] same, same_q, valid_ways_q, pending_ways_q, hits, follows;
  logic hit, follow, some_way;

  assign {asked_tag, asked_set} = line_number_i;
  assign go      = ~request_q | done;
  assign ready_o = ~compare_q | go;
  assign ask     = valid_i & ready_o;
  assign outstanding_o = (compare_q & ~compare_demand_q) | (request_q & ~demand_q);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) {compare_q, request_q} <= '0;
    else {compare_q, request_q} <= {ask | (compare_q & ~go), compare_q | ~go};
  end
  always_ff @(posedge clk_i) begin
    if (ask) begin
      compare_demand_q <= demand_i;
      compare_ray_q    <= ray_i;
      compare_tag_q    <= asked_tag;
      compare_set_q    <= asked_set;
      // The ram reads the old value of a tag that is written at this edge.
      changed_q     <= allocate & (asked_set == set);
      changed_way_q <= way;
      changed_tag_q <= tag;
    end
    if (go) begin
      {demand_q, ray_q} <= {compare_demand_q, compare_ray_q};
      {tag, set}        <= {compare_tag_q, compare_set_q};
      same_q  <= same;
      start_q <= victims_q[compare_set_q];
    end
  end

  ram #(
    .Width(Ways * TagWidth),
    .Depth(Sets),
    .Parts(Ways)
  ) u_tags (
    .clk_i,
    .write_i({Ways{allocate}} & (Ways'(1) << way)),
    .write_address_i(set),
    .data_i({Ways{tag}}),
    .read_i(ask),
    .read_address_i(asked_set),
    .data_o(set_tags)
  );

  // ---- Compare: same, valid_ways_q and pending_ways_q take into account what the look-up changes in this clock

  logic [SetWidth-1:0] fill_set;
  logic [WayWidth-1:0] fill_way;
  logic arrive, is_changed, same_as_changed, same_as_tag;
  assign {fill_way, fill_set} = fill_entry_i;
  assign same_as_changed = compare_tag_q == changed_tag_q;
  assign same_as_tag     = compare_tag_q == tag;
  assign is_changed      = allocate & (compare_set_q == set);

  for (genvar w = 0; w < Ways; w++) begin : gen_way
    logic [Sets-1:0] valid_sets, pending_sets;
    logic arrives, changes;
    assign arrives = arrive & (fill_way == WayWidth'(w)) & (fill_set == (go ? compare_set_q : set));
    assign changes = is_changed & (way == WayWidth'(w));
    assign same[w] = changes ? same_as_tag
                   : (changed_q & changed_way_q == WayWidth'(w)) ? same_as_changed
                   : set_tags[w] == compare_tag_q;
    assign valid_sets   = valid_q[Sets*w +: Sets];
    assign pending_sets = pending_q[Sets*w +: Sets];
    always_ff @(posedge clk_i) begin
      if (go) begin
        valid_ways_q[w]   <= valid_sets[compare_set_q] & ~changes;
        pending_ways_q[w] <= pending_sets[compare_set_q] | changes;
      end
      if (arrives) begin
        valid_ways_q[w]   <= ~fill_error_i;
        pending_ways_q[w] <= 1'b0;
      end
    end
  end

  // ---- Look up

  logic [EntryWidth-1:0] entry;

  rr_arbiter #(
    .Width(Ways)
  ) u_victim (
    .requests_i(~pending_ways_q),
    .start_i(start_q),
    .valid_o(some_way),
    .index_o(victim_way)
  );

  assign hits    = same_q & valid_ways_q;
  assign follows = same_q & pending_ways_q;
  assign hit    = hits != '0;
  assign follow = follows != '0;
  assign entry  = {way, set};  // low bits select first in memories; the set is known first

  always_comb begin
    way = (hit | follow) ? '0 : victim_way;
    for (int unsigned w = 0; w < Ways; w++) begin
      if (hits[w] | follows[w]) way = way | WayWidth'(w);
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) victims_q <= '0;
    else if (request_q && done) victims_q[set] <= way + 1'b1;
  end

  // ---- Targets: lists of requests that wait, one for each entry

  logic [Targets-1:0] free_q;
  logic [TargetWidth-1:0] target, current_q;
  logic [TargetWidth:0] nexts[Targets];  // {an earlier target exists, that target}
  logic [TargetWidth:0] heads[Lines];  // {a target exists, the latest}
  logic [Lines-1:0] mores_q;  // a target earlier than the head exists
  logic [TargetWidth:0] head, fill_head;
  logic [RayWidth-1:0] rays[Targets];
  logic some_free, add_target, draining_q, more_q, give, error_q;
  logic [Width-1:0] line_q;
  logic room;  // for one more hit in the queue below

  rr_arbiter #(
    .Width(Targets)
  ) u_pick (
    .requests_i(free_q),
    .start_i('0),
    .valid_o(some_free),
    .index_o(target)
  );

  always_comb begin
    if (hit) done = room;
    else if (follow) done = some_free & ~(arrive & fill_set == set & follows[fill_way]);
    else done = some_way & miss_ready_i & some_free;
    if (!demand_q) done = 1'b1;
  end

  assign miss_valid_o  = request_q & ~hit & ~follow & some_way & (some_free | ~demand_q);
  assign miss_entry_o  = entry;
  assign miss_number_o = {tag, set};
  assign allocate      = miss_valid_o & miss_ready_i;
  assign add_target    = request_q & done & demand_q & ~hit;
  assign head          = heads[entry];

  always_ff @(posedge clk_i) begin
    if (add_target) begin
      rays[target]  <= ray_q;
      nexts[target] <= {mores_q[entry], head[TargetWidth-1:0]};
    end
    if (add_target || allocate) begin
      heads[entry]   <= {demand_q, target};
      mores_q[entry] <= follow & head[TargetWidth];
    end
  end

  // ---- A line comes, and goes to all its targets

  assign give         = draining_q & ready_i;
  assign fill_ready_o = ~draining_q | (give & ~more_q);
  assign arrive       = fill_i & fill_ready_o;
  assign fill_head    = heads[fill_entry_i];

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      valid_q    <= '0;
      pending_q  <= '0;
      free_q     <= '1;
      draining_q <= 1'b0;
    end else begin
      if (arrive) begin
        valid_q[fill_entry_i]   <= ~fill_error_i;
        pending_q[fill_entry_i] <= 1'b0;
      end
      if (fill_ready_o) draining_q <= arrive & fill_head[TargetWidth];
      if (give) free_q[current_q] <= 1'b1;
      if (allocate) begin
        valid_q[entry]   <= 1'b0;
        pending_q[entry] <= 1'b1;
      end
      if (invalidate_i) valid_q <= '0;
      if (add_target) free_q[target] <= 1'b0;
    end
  end
  always_ff @(posedge clk_i) begin
    if (fill_ready_o) begin
      {more_q, current_q} <= {mores_q[fill_entry_i], fill_head[TargetWidth-1:0]};
      {error_q, line_q}   <= {fill_error_i, fill_line_i};
    end else if (give) begin
      {more_q, current_q} <= nexts[current_q];
    end
  end

  // ---- Hits wait for a clock in which no line from memory leaves

  logic read_hit, hit_q, queued, leaves;
  logic [RayWidth-1:0] hit_ray_q, queued_ray;
  logic [Width-1:0] hit_line, queued_line;

  assign read_hit = request_q & demand_q & hit & room;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) hit_q <= 1'b0;
    else hit_q <= read_hit;
  end
  always_ff @(posedge clk_i) hit_ray_q <= ray_q;

  ram #(
    .Width(Width),
    .Depth(Lines)
  ) u_lines (
    .clk_i,
    .write_i(arrive),
    .write_address_i(fill_entry_i),
    .data_i(fill_line_i),
    .read_i(read_hit),
    .read_address_i(entry),
    .data_o(hit_line)
  );
  fifo #(
    .Width(RayWidth + Width),
    .Depth(16),
    .Reserve(1),
    .Memory(1'b1)
  ) u_hits (
    .clk_i,
    .rst_ni,
    .push_i(hit_q),
    .data_i({hit_ray_q, hit_line}),
    .space_o(room),
    .pop_i(leaves),
    .valid_o(queued),
    .data_o({queued_ray, queued_line})
  );

  assign leaves  = queued & ready_i & ~draining_q;
  assign valid_o = give | leaves;
  assign ray_o   = draining_q ? rays[current_q] : queued_ray;
  assign line_o  = draining_q ? line_q : queued_line;
  assign error_o = draining_q & error_q;

endmodule
