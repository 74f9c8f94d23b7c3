// Lines of one kind, nodes or triangles, that were read not long ago.
//
// Direct-mapped, Lines lines. A request that hits gives its line in the next clock. One that misses enlists, under a
// number of its own, and its line is asked for; those that want the same line before it has come enlist behind
// it, so that it is read once. Where another line is on its way to the same place, a request asks for its
// line alone, which is not kept.
//
// A line from memory goes to all that are enlisted for it, one a clock, the latest first: then fill_done_o, and
// the line may go. It is offered until then. Lines leave in any order, one a clock, each with the ray that
// asked; those from memory first, while what hit waits in a short queue and requests are looked up as before.
//
// Memory is read only; invalidate_i, while nothing is enlisted, empties the cache.
module line_cache #(
  parameter int unsigned Lines    = 256,  // a power of two
  parameter int unsigned Waiters  = 64,   // that may be enlisted; a power of two
  parameter int unsigned RayWidth = 6,
  parameter int unsigned Width    = ray_core_pkg::LineWidth,  // of what is kept of a line
  localparam int unsigned IndexWidth = $clog2(Lines),
  localparam int unsigned WaiterWidth = $clog2(Waiters),
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    invalidate_i,
  // what is asked for
  input  logic                    valid_i,
  output logic                    ready_o,
  input  logic [RayWidth-1:0]     ray_i,
  input  logic [AddressWidth-1:0] line_number_i,
  // what is not here
  output logic                    miss_valid_o,
  input  logic                    miss_ready_i,
  output logic [WaiterWidth-1:0]  miss_waiter_o,
  output logic                    miss_alone_o,
  output logic [AddressWidth-1:0] miss_number_o,
  // what comes from memory
  input  logic                    fill_i,
  output logic                    fill_done_o,
  input  logic [WaiterWidth-1:0]  fill_waiter_i,  // counts where the line is alone
  input  logic                    fill_alone_i,
  input  logic [IndexWidth-1:0]   fill_index_i,  // the lowest bits of its number
  input  logic [Width-1:0]        fill_line_i,
  // lines
  output logic                    valid_o,
  input  logic                    ready_i,  // else nothing leaves, and fill_i must be low
  output logic [RayWidth-1:0]     ray_o,
  output logic [Width-1:0]        line_o
);

  localparam int unsigned LabelWidth = AddressWidth - IndexWidth;

  logic [Width-1:0] words[Lines];
  logic [LabelWidth-1:0] labels[Lines];
  logic [WaiterWidth-1:0] heads[Lines];  // who enlisted last
  logic [Lines-1:0] held_q, pending_q;  // the line is here, or on its way

  // ---- Look up

  logic [IndexWidth-1:0] index;
  logic match, hit, follow, blocked, room, enlist, allocate, arrive;

  assign index      = line_number_i[IndexWidth-1:0];
  assign match      = labels[index] == line_number_i[AddressWidth-1:IndexWidth];
  assign hit        = held_q[index] & match;
  assign follow     = pending_q[index] & match;
  assign blocked    = arrive & (index == fill_index_i);

  // ---- Enlist

  logic [Waiters-1:0] free_q;
  logic [Waiters-1:0] follows_q;  // somebody enlisted before, for the same line
  logic [WaiterWidth-1:0] waiter, current, current_q;
  logic [WaiterWidth-1:0] nexts[Waiters];  // who that was
  logic [RayWidth-1:0] rays[Waiters];
  logic some_free, draining_q, more;

  rotating_pick #(
    .Width(Waiters)
  ) u_pick (
    .requests_i(free_q),
    .start_i('0),
    .valid_o(some_free),
    .index_o(waiter)
  );

  assign ready_o       = ~blocked & (hit ? room : some_free & (follow | miss_ready_i));
  assign miss_valid_o  = valid_i & ~blocked & ~hit & ~follow & some_free;
  assign miss_alone_o  = pending_q[index];
  assign miss_waiter_o = waiter;
  assign miss_number_o = line_number_i;
  assign enlist        = valid_i & ready_o & ~hit;
  assign allocate      = enlist & ~pending_q[index];

  always_ff @(posedge clk_i) begin
    if (enlist) begin
      rays[waiter]  <= ray_i;
      nexts[waiter] <= heads[index];
      if (allocate || follow) heads[index] <= waiter;
    end
    if (allocate) labels[index] <= line_number_i[AddressWidth-1:IndexWidth];
  end

  // ---- A line comes, and goes to all that are enlisted

  assign current     = fill_alone_i ? fill_waiter_i : draining_q ? current_q : heads[fill_index_i];
  assign more        = follows_q[current];  // never of one that is alone
  assign arrive      = fill_i & ~fill_alone_i & ~draining_q;
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
        held_q[fill_index_i]    <= 1'b1;
        pending_q[fill_index_i] <= 1'b0;
      end
      if (allocate) begin
        held_q[index]    <= 1'b0;
        pending_q[index] <= 1'b1;
      end
      if (invalidate_i) held_q <= '0;
      if (fill_i) begin
        free_q[current] <= 1'b1;
        draining_q      <= more;
      end
      if (enlist) begin
        free_q[waiter]    <= 1'b0;
        follows_q[waiter] <= follow;
      end
    end
  end
  always_ff @(posedge clk_i) begin
    if (fill_i) current_q <= nexts[current];
    if (arrive) words[fill_index_i] <= fill_line_i;
  end

  // ---- What hit waits for a clock in which no line comes from memory

  logic queued, leaves;
  logic [RayWidth-1:0] queued_ray;
  logic [Width-1:0] queued_line;

  fifo #(
    .Width(RayWidth + Width),
    .Depth(4)
  ) u_hits (
    .clk_i,
    .rst_ni,
    .push_i(valid_i & hit & ready_o),
    .data_i({ray_i, words[index]}),
    .space_o(room),
    .pop_i(leaves),
    .valid_o(queued),
    .data_o({queued_ray, queued_line})
  );

  assign leaves  = queued & ready_i & ~fill_i;
  assign valid_o = fill_i | leaves;
  assign ray_o   = fill_i ? rays[current] : queued_ray;
  assign line_o  = fill_i ? fill_line_i : queued_line;

endmodule
