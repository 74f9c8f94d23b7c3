// Closest hit of each ray: its nearest certain hit, t_max, its doubts.
//
// A hit's t may be off by 2**t_error units (set_up_pkg), so it has an upper and a lower bound. Of a ray's certain hits,
// the hit with the smallest upper bound is kept; this bound becomes the ray's t_max. A hit whose lower bound is beyond
// t_max is dropped. If the bounds of two hits overlap, either may be nearer: the hit that is not kept becomes a doubt.
// A test without a sure verdict is a doubt, too. Distances are positive floats, which compare as integers. At first,
// t_max is the user's; a hit that may lie beyond it is a doubt. A ray with any_hit ends with its first certain hit.
//
// There are Queue credits. A test takes one at test_i, and returns it when it ends; if it leaves a doubt, when the
// doubt leaves. tests_allowed_o is low while no credit is free. So no test and no line from memory waits for doubts.
//
// With Exact, no doubt leaves the core: open_o passes each to exact_resolver in the clock in which it arises. If a
// doubt turns out to be the ray's nearest hit, its triangle is tested again with settle_i, as the ray's last test. This
// hit is kept whatever the verdict: with t and P if the test is sure, else with NoT as its t_error.
//
// Throughput: a result a clock; each is compared in the clock after it arrives. A ray has tests in flight until as many
// of its results have been compared as it had clocks with test_i.
module closest_hit
  import ray_core_pkg::*;
#(
  parameter int unsigned Rays = 64,
  parameter bit Exact = 1'b0,
  parameter int unsigned Queue = 2 * Rays + 128,  // doubts: all tests that can be in flight
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  // a ray comes in
  input  logic                    load_i,
  input  logic [RayWidth-1:0]     load_ray_i,
  input  logic [30:0]             load_t_max_i,
  input  logic                    load_any_hit_i,
  // a test begins: a ray's triangle was requested
  input  logic                    test_i,
  input  logic [RayWidth-1:0]     test_ray_i,
  input  logic                    settle_i,  // with test_i: test of a doubt that is the nearest hit
  output logic                    tests_allowed_o,
  // a test is over
  input  logic [RayWidth-1:0]     result_ray_i,
  input  logic [31:0]             result_tag_i,  // tag of result_ray_i, for doubts
  input  verdict_t                result_i,
  // t_max of a ray, a clock after its number (exact_o: in the same clock); ended: it has any_hit and a hit, or failed
  input  logic [Rays-1:0]         failed_i,
  input  logic [RayWidth-1:0]     traversal_ray_i,
  output logic [30:0]             traversal_t_max_o,
  output logic                    traversal_ended_o,
  input  logic [RayWidth-1:0]     leaf_ray_i,
  output logic [30:0]             leaf_t_max_o,
  output logic                    leaf_ended_o,
  input  logic [RayWidth-1:0]     box_ray_i,
  output logic [30:0]             box_t_max_o,
  input  logic [RayWidth-1:0]     exact_ray_i,
  output known_t                  exact_o,
  output logic [Rays-1:0]         testing_o,
  // doubts
  output doubt_t                  doubt_o,
  input  logic                    doubt_fire_i,  // doubt_o leaves, or exact_resolver takes a doubt
  output logic [RayWidth-1:0]     open_ray_o,
  output open_t                   open_o,
  // the nearest hit of the ray end_ray_i, in the same clock
  input  logic [RayWidth-1:0]     end_ray_i,
  output hit_t                    end_o,
  // the P of the hit that the ray point_ray_i kept last, a clock later
  input  logic [RayWidth-1:0]     point_ray_i,
  output logic [95:0]             point_o,
  // event of this clock, for counters
  output logic                    near_tie_o
);

  localparam int unsigned CountWidth = $clog2(Queue + 2);  // up to Queue + 1, one with settle_i

  logic [30:0] t_max[Rays];
  logic [31:0] nearest_t[Rays];
  logic [31:0] nearest_low[Rays];  // lower bound of nearest_t
  logic [TErrorWidth-1:0] nearest_error[Rays];
  logic [31:0] nearest_triangle[Rays];
  logic [TestsWidth-1:0] tests[Rays];
  logic [CountWidth-1:0] counts[Rays];  // number of tests in flight
  logic [Rays-1:0] found_q, any_hit_q, ended;
  logic [RayWidth-1:0] traversal_ray_q, leaf_ray_q, box_ray_q;

  assign ended = (found_q & any_hit_q) | failed_i;

  always_ff @(posedge clk_i) begin
    {traversal_ray_q, leaf_ray_q, box_ray_q} <= {traversal_ray_i, leaf_ray_i, box_ray_i};
  end

  assign traversal_t_max_o   = t_max[traversal_ray_q];
  assign traversal_ended_o   = ended[traversal_ray_q];
  assign leaf_t_max_o        = t_max[leaf_ray_q];
  assign leaf_ended_o        = ended[leaf_ray_q];
  assign box_t_max_o         = t_max[box_ray_q];
  assign exact_o.ended       = ended[exact_ray_i];
  assign exact_o.found       = found_q[exact_ray_i];
  assign exact_o.line        = AddressWidth'(nearest_triangle[exact_ray_i]);
  assign exact_o.t_max       = t_max[exact_ray_i];

  // ---- Read: the result, and the ray's nearest hit so far

  logic good, is_over_q, is_sure_q, is_vague_q, replace, forward, old_found_q, settled_q;
  logic [RayWidth-1:0] ray_q;
  logic [TErrorWidth-1:0] t_error, t_error_q;
  logic [31:0] margin, sum, t_q, low_q, high_q, tag_q, triangle_q, old_low_q, old_triangle_q;
  logic [30:0] old_t_max_q;
  logic [95:0] point_q;
  logic [Rays-1:0] settling_q;

  assign good = set_up_pkg::is_good_hit(TErrorWidth'(result_i.t_error), result_i.normal_error);
  assign t_error = set_up_pkg::t_error_exponent(
      TErrorWidth'(result_i.t_error), result_i.normal_error, result_i.distance_error);
  assign margin  = 32'd1 << t_error;
  assign sum     = result_i.t + margin;
  assign forward = replace & (ray_q == result_ray_i);  // the nearest so far is in the next stage

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      {is_over_q, is_sure_q, is_vague_q, settled_q} <= '0;
      settling_q <= '0;
    end else begin
      if (load_i) settling_q[load_ray_i] <= 1'b0;
      if (test_i && settle_i) settling_q[test_ray_i] <= 1'b1;
      settled_q  <= Exact & result_i.valid & settling_q[result_ray_i];
      is_over_q  <= result_i.valid;
      is_sure_q  <= result_i.valid & ~result_i.is_skipped & result_i.found & good;
      is_vague_q <= result_i.valid & ~result_i.is_skipped
                  & (result_i.doubt | (result_i.found & ~good));
    end
  end
  always_ff @(posedge clk_i) begin
    ray_q          <= result_ray_i;
    tag_q          <= result_tag_i;
    triangle_q     <= result_i.triangle;
    t_q            <= result_i.t;
    t_error_q      <= t_error;
    point_q        <= result_i.point;
    low_q          <= (result_i.t > margin) ? result_i.t - margin : '0;
    high_q         <= (sum < {1'b0, Infinity}) ? sum : {1'b0, Infinity};
    old_found_q    <= forward | found_q[result_ray_i];
    old_t_max_q    <= forward ? high_q[30:0] : t_max[result_ray_i];
    old_low_q      <= forward ? low_q : nearest_low[result_ray_i];
    old_triangle_q <= forward ? triangle_q : nearest_triangle[result_ray_i];
  end

  // ---- Compare

  logic open, old_open, doubt;
  logic [31:0] doubt_triangle;

  assign replace    = is_sure_q & (settled_q | (high_q < {1'b0, old_t_max_q}));
  assign old_open   = replace & ~settled_q & old_found_q & (old_low_q <= high_q);
  assign open       = is_sure_q & ~replace & (low_q <= {1'b0, old_t_max_q});
  assign near_tie_o = old_open | open;
  assign doubt      = (is_vague_q & ~settled_q) | near_tie_o;
  assign doubt_triangle = old_open ? old_triangle_q : triangle_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      found_q   <= '0;
      any_hit_q <= '0;
    end else begin
      if (load_i) begin
        found_q[load_ray_i]   <= 1'b0;
        any_hit_q[load_ray_i] <= load_any_hit_i;
      end
      if (replace | settled_q) found_q[ray_q] <= 1'b1;
    end
  end
  always_ff @(posedge clk_i) begin
    if (load_i) t_max[load_ray_i] <= load_t_max_i;
    if (replace | settled_q) begin
      t_max[ray_q]            <= high_q[30:0];
      nearest_t[ray_q]        <= is_sure_q ? t_q : '0;
      nearest_low[ray_q]      <= low_q;
      nearest_error[ray_q]    <= is_sure_q ? t_error_q : NoT;
      nearest_triangle[ray_q] <= triangle_q;
    end
  end

  // ---- Doubts

  logic [CountWidth-1:0] here_q;  // tests in flight, without settle_i's, and doubts
  logic taken, returned;  // a credit is taken, is returned

  assign taken    = test_i & ~settle_i;
  assign returned = is_over_q & ~settled_q & ~doubt;
  assign tests_allowed_o = here_q < CountWidth'(Queue);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) here_q <= '0;
    else here_q <= here_q + CountWidth'(taken) - CountWidth'(returned) - CountWidth'(doubt_fire_i);
  end

  fifo #(
    .Width(32 + 32),
    .Depth(Exact ? 2 : Queue),
    .Memory(1'b1)
  ) u_doubts (
    .clk_i,
    .rst_ni,
    .push_i(doubt & ~Exact),
    .data_i({tag_q, doubt_triangle}),
    .space_o(),
    .pop_i(doubt_fire_i & ~Exact),
    .valid_o(doubt_o.valid),
    .data_o({doubt_o.tag, doubt_o.triangle})
  );

  assign open_ray_o    = ray_q;
  assign open_o.valid  = doubt & Exact;
  assign open_o.is_hit = near_tie_o;
  assign open_o.line   = AddressWidth'(doubt_triangle);

  ram #(
    .Width(96),
    .Depth(Rays)
  ) u_kept (
    .clk_i,
    .write_i(replace),
    .write_address_i(ray_q),
    .data_i(point_q),
    .read_i(1'b1),
    .read_address_i(point_ray_i),
    .data_o(point_o)
  );

  // ---- Tests in flight

  logic [RayWidth-1:0] test_ray_q;
  logic test_q, same;
  assign same = test_q & is_over_q & (test_ray_q == ray_q);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      test_q    <= 1'b0;
      testing_o <= '0;
    end else begin
      test_q <= test_i;
      if (is_over_q && !same && counts[ray_q] == CountWidth'(1)) testing_o[ray_q] <= 1'b0;
      if (test_i) testing_o[test_ray_i] <= 1'b1;
    end
  end
  always_ff @(posedge clk_i) begin
    if (load_i) begin
      counts[load_ray_i] <= '0;
      tests[load_ray_i]  <= '0;
    end
    test_ray_q <= test_ray_i;
    if (test_q) tests[test_ray_q] <= tests[test_ray_q] + 1'b1;
    if (test_q && !same) counts[test_ray_q] <= counts[test_ray_q] + 1'b1;
    if (is_over_q && !same) counts[ray_q] <= counts[ray_q] - 1'b1;
  end

  // ---- The nearest hit, for a ray that ends

  assign end_o.found    = found_q[end_ray_i];
  assign end_o.triangle = nearest_triangle[end_ray_i];
  assign end_o.t        = nearest_t[end_ray_i];
  assign end_o.t_error  = nearest_error[end_ray_i];
  assign end_o.tests    = tests[end_ray_i];

endmodule
