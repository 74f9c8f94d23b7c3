// Exit of rays: detects that a ray has ended, and queues results.
//
// A ray has ended when it has no node, no leaf, no test and no doubt left. Its context is free at once; its nearest hit
// waits in a queue. A ray's doubts leave before its end. Unused fields of a result are zero: a doubt has only tag and
// triangle; the end of a ray without a hit has no triangle, t, t_error or P. Throughput: a ray and a result a clock.
module ray_retire
  import ray_core_pkg::*;
#(
  parameter int unsigned Rays = 64,
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                clk_i,
  input  logic                rst_ni,
  input  logic                start_i,  // a ray enters the context start_ctx_i
  input  logic [RayWidth-1:0] start_ctx_i,
  input  logic [Rays-1:0]     busy_i,  // contexts whose ray has work left
  // a ray ends and its context is free; its data come in the next clock
  output logic                ending_o,
  output logic [RayWidth-1:0] ending_ctx_o,
  output logic [RayWidth-1:0] end_ctx_o,
  input  end_t                end_i,
  input  logic [95:0]         point_i,
  // doubts
  input  doubt_t              doubt_i,
  output logic                doubt_fire_o,
  // results
  output logic                result_valid_o,
  input  logic                result_ready_i,
  output result_t             result_o
);

  localparam int unsigned Depth = 8;  // for a throughput of one end per clock

  // ---- The end of a ray

  logic [Rays-1:0] active_q;  // contexts with a ray whose end is not detected yet
  logic some, space;

  rr_arbiter #(
    .Width(Rays)
  ) u_pick (
    .requests_i(active_q & ~busy_i),
    .start_i('0),
    .valid_o(some),
    .index_o(ending_ctx_o)
  );
  assign ending_o = some & space;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      active_q <= '0;
    end else begin
      if (start_i) active_q[start_ctx_i] <= 1'b1;
      if (ending_o) active_q[ending_ctx_o] <= 1'b0;
    end
  end

  // ---- Queue of the data of rays that have ended

  logic known_q, end_valid, end_fire;
  end_t ended;
  logic [95:0] end_point;

  always_ff @(posedge clk_i) end_ctx_o <= ending_ctx_o;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) known_q <= 1'b0;
    else known_q <= ending_o;
  end
  fifo #(
    .Width($bits(end_i) + 96),
    .Depth(Depth),
    .Reserve(1),
    .Memory(1'b1)
  ) u_ends (
    .clk_i,
    .rst_ni,
    .push_i(known_q),
    .data_i({end_i, point_i}),
    .space_o(space),
    .pop_i(end_fire),
    .valid_o(end_valid),
    .data_o({ended, end_point})
  );

  // ---- Results

  logic load, end_found;

  assign end_found    = ended.hit.found & ~doubt_i.valid;
  assign load         = ~result_valid_o | result_ready_i;
  assign doubt_fire_o = load & doubt_i.valid;
  assign end_fire     = load & end_valid & ~doubt_i.valid;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) result_valid_o <= 1'b0;
    else if (load) result_valid_o <= doubt_i.valid | end_valid;
  end
  always_ff @(posedge clk_i) begin
    if (load) begin
      result_o       <= '0;
      result_o.kind  <= doubt_i.valid ? ResultDoubt : ResultEnd;
      result_o.tag   <= doubt_i.valid ? doubt_i.tag : ended.tag;
      result_o.found <= end_found;
      if (doubt_i.valid) begin
        result_o.triangle <= doubt_i.triangle;
      end else begin
        result_o.tests <= ended.hit.tests;
        result_o.error <= ended.error;
      end
      if (end_found) begin
        result_o.triangle <= ended.hit.triangle;
        result_o.t        <= ended.hit.t;
        result_o.t_error  <= ended.hit.t_error;
        if (ended.hit.t_error != NoT) result_o.point <= end_point;
      end
    end
  end

endmodule
