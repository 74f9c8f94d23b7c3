// Entry of rays: reciprocals of a ray's direction, and a context.
//
// A ray waits in a queue: first for its reciprocals, which take the latency of a division, then for a free context.
// start_ctx_o is the lowest free context. So no context is held during a division. Reciprocals are rounded to nearest.
// Throughput: a ray in Clocks clocks; there are three dividers if Clocks is 1, one if it is 7 or more.
module ray_alloc #(
  parameter int unsigned Rays  = 64,  // number of contexts
  parameter int unsigned Width = 32,  // width of a ray's data, without the reciprocals
  parameter int unsigned Clocks = 1,
  parameter int unsigned Arith = arith_pkg::Graded,
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

  localparam int unsigned Depth = hit_test_pkg::divide_latency(23) + 3;  // for one ray per clock

  if (Rays < 2 || 2 ** RayWidth != Rays || (Clocks != 1 && Clocks < 7)) begin : gen_check
    $error("ray_alloc: expected Rays of 2 or more, a power of two, and Clocks of 1, or 7 or more");
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

  // ---- Divide: all words at once, or one per clock

  localparam int unsigned Latency = hit_test_pkg::divide_latency(23);
  localparam int unsigned Dividers = (Clocks == 1) ? 3 : 1;
  localparam logic [31:0] One = 32'h3f80_0000;
  logic fire, space, divider_ready, divide, divided;
  logic [Latency-1:0] dividing_q;
  logic [Dividers*32-1:0] divisors, quotients;
  logic [95:0] inverse;

  assign ready_o = rst_ni & space & divider_ready;
  assign fire    = valid_i & ready_o;

  for (genvar k = 0; k < Dividers; k++) begin : gen_divider
    fp_divider #(
      .Arith(Arith),
      .Pipelined(1'b1)
    ) u_divider (
      .clk_i,
      .valid_i(divide),
      .a_i(One),
      .b_i(divisors[32*k +: 32]),
      .rounding_mode_i(fp_pkg::RoundNearestEven),
      .tininess_after_i(1'b0),
      .result_o(quotients[32*k +: 32]),
      .flags_o()
    );
  end
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) dividing_q <= '0;
    else dividing_q <= {dividing_q[Latency-2:0], divide};
  end

  if (Clocks == 1) begin : gen_at_once
    assign divider_ready = 1'b1;
    assign divide        = fire;
    assign divisors      = direction_i;
    assign inverse       = quotients;
    assign divided       = dividing_q[Latency-1];
  end else begin : gen_turns
    logic [Clocks-2:0] since_q;  // [n]: a vector was taken n + 1 clocks ago
    logic [95:0] words_q;
    logic [63:0] earlier_words_q;
    logic [1:0] earlier_q;  // quotients of the vector that have come

    assign divider_ready = since_q == '0;
    assign divide        = |since_q[2:0];
    assign divisors      = words_q[31:0];
    assign inverse       = {quotients, earlier_words_q};
    assign divided       = dividing_q[Latency-1] & (earlier_q == 2'd2);

    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) begin
        since_q   <= '0;
        earlier_q <= '0;
      end else begin
        since_q <= {since_q[Clocks-3:0], fire};
        if (dividing_q[Latency-1]) earlier_q <= divided ? '0 : earlier_q + 1'b1;
      end
    end
    always_ff @(posedge clk_i) begin
      words_q <= fire ? direction_i : words_q >> 32;
      if (dividing_q[Latency-1]) earlier_words_q <= inverse[95:32];
    end
  end

  // ---- Queues; u_inverses is never fuller than u_rays

  logic inverse_valid;

  fifo #(
    .Width(Width),
    .Depth(Depth),
    .Memory(1'b1)
  ) u_rays (
    .clk_i,
    .rst_ni,
    .push_i(fire),
    .data_i(ray_i),
    .space_o(space),
    .pop_i(start_fire_i),
    .valid_o(),
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
    .space_o(),
    .pop_i(start_fire_i),
    .valid_o(inverse_valid),
    .data_o(start_inverse_o)
  );

  assign start_valid_o = inverse_valid & some_free;

endmodule
