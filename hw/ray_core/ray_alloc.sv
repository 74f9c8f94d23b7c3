// Entry of rays: computes the reciprocals of a ray's direction and gives the ray a context.
//
// A ray waits in a queue until its reciprocals have come, a division's latency later, and a context is free: the
// lowest free one is start_ctx_o. So no context is held by a division. Throughput a ray in Clocks clocks.
module ray_alloc #(
  parameter int unsigned Rays  = 64,  // contexts
  parameter int unsigned Width = 32,  // of what else there is of a ray
  parameter int unsigned Clocks = 1,  // of a ray, see reciprocals
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                clk_i,
  input  logic                rst_ni,
  input  logic                valid_i,
  output logic                ready_o,
  input  logic [95:0]         direction_i,
  input  logic [Width-1:0]    ray_i,
  input  logic                free_valid_i,   // a context is free again
  input  logic [RayWidth-1:0] free_ctx_i,
  output logic                start_valid_o,  // a ray and its context
  output logic [RayWidth-1:0] start_ctx_o,
  output logic [95:0]         start_inverse_o,
  output logic [Width-1:0]    start_ray_o,
  input  logic                start_fire_i
);

  localparam int unsigned Depth = hit_test_pkg::divide_latency(23) + 3;  // for a ray a clock

  if (Rays < 2 || 2 ** RayWidth != Rays) begin : gen_check
    $error("ray_alloc: expected Rays to be a power of two, at least 2");
  end

  // ---- Contexts

  logic [Rays-1:0] free_q;
  logic some_free;

  rr_arbiter #(
    .Width(Rays)
  ) u_pick (
    .requests_i(free_q),
    .start_i('0),
    .valid_o(some_free),
    .index_o(start_ctx_o)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      free_q <= '1;
    end else begin
      if (start_fire_i) free_q[start_ctx_o] <= 1'b0;
      if (free_valid_i) free_q[free_ctx_i] <= 1'b1;
    end
  end

  // ---- Divide

  logic fire, space, divider_ready, divided;
  logic [95:0] inverse;

  assign ready_o = rst_ni & space & divider_ready;
  assign fire    = valid_i & ready_o;

  reciprocals #(
    .Clocks(Clocks),
    .Arith(Arith),
    .Adder(Adder)
  ) u_reciprocals (
    .clk_i,
    .rst_ni,
    .valid_i(fire),
    .ready_o(divider_ready),
    .vector_i(direction_i),
    .valid_o(divided),
    .inverse_o(inverse)
  );

  // ---- Wait: as many inverses at most as there are rays

  logic inverse_valid, unused_valid, unused_space;

  ram_fifo #(
    .Width(Width),
    .Depth(Depth)
  ) u_rays (
    .clk_i,
    .rst_ni,
    .push_i(fire),
    .data_i(ray_i),
    .space_o(space),
    .pop_i(start_fire_i),
    .valid_o(unused_valid),
    .data_o(start_ray_o)
  );
  fifo #(
    .Width(96),
    .Depth(Depth)
  ) u_inverses (
    .clk_i,
    .rst_ni,
    .push_i(divided),
    .data_i(inverse),
    .space_o(unused_space),
    .pop_i(start_fire_i),
    .valid_o(inverse_valid),
    .data_o(start_inverse_o)
  );

  assign start_valid_o = inverse_valid & some_free;

endmodule
