// Closest hit of each ray: its nearest sure hit and t_max, its doubts, and how many of its tests are in flight.
//
// Of a ray's sure hits the one whose upper bound of t is the smallest is kept; that bound is the ray's t_max. A hit
// that is surely farther is forgotten. One that is neither nearer nor farther for sure leaves as a doubt, as does
// the hit that it replaces and a test without a verdict. Distances are positive floats, ordered as integers; a
// hit's may be off by 2**t_error units (set_up_pkg). At first t_max is the user's, so that a hit that may be
// beyond it is a doubt. A ray that wants any hit ends with its first sure one.
//
// A result is taken in each clock; a ray's tests are over when result_i has been high as often for it as test_i. P
// comes later, in the order of the results that were hits, PointDelay clocks at most.
module closest_hit #(
  parameter int unsigned Rays = 64,
  parameter int unsigned InFlight = 64,  // tests that are on their way when tests_allowed_o falls
  localparam int unsigned RayWidth = $clog2(Rays),
  localparam int unsigned PlaneErrorWidth = set_up_pkg::PlaneErrorWidth,
  localparam int unsigned TErrorWidth = set_up_pkg::TErrorExponentWidth,
  localparam int unsigned TestsWidth = ray_core_pkg::TestsWidth
) (
  input  logic                       clk_i,
  input  logic                       rst_ni,
  // a ray comes in
  input  logic                       load_i,
  input  logic [RayWidth-1:0]        load_ray_i,
  input  logic [30:0]                load_t_max_i,
  input  logic                       load_any_hit_i,
  // a test sets out, a ray's triangle was asked for
  input  logic                       test_i,
  input  logic [RayWidth-1:0]        test_ray_i,
  output logic                       tests_allowed_o,  // room for the doubts of all on their way
  // a test is over
  input  logic                       result_i,
  input  logic [RayWidth-1:0]        result_ray_i,
  input  logic [31:0]                result_tag_i,      // the ray's, for doubts
  input  logic [31:0]                result_triangle_i,
  input  logic                       result_skipped_i,  // it counts for nothing
  input  logic                       result_doubt_i,
  input  logic                       result_hit_i,
  input  logic [31:0]                result_t_i,
  input  logic [hit_test_pkg::TErrorWidth-1:0] result_t_error_i,
  input  logic [PlaneErrorWidth-1:0] result_normal_error_i,
  input  logic [PlaneErrorWidth-1:0] result_distance_error_i,
  input  logic                       point_valid_i,
  input  logic [95:0]                point_i,
  // t_max, by ray, in the same clock
  input  logic [RayWidth-1:0]        traversal_ray_i,
  output logic [30:0]                traversal_t_max_o,
  output logic                       traversal_ended_o,
  input  logic [RayWidth-1:0]        leaf_ray_i,
  output logic [30:0]                leaf_t_max_o,
  output logic                       leaf_ended_o,
  output logic                       leaf_counter_full_o,
  input  logic [RayWidth-1:0]        box_ray_i,
  output logic [30:0]                box_t_max_o,
  output logic [Rays-1:0]            testing_o,
  // doubts
  output logic                       doubt_valid_o,
  output logic [31:0]                doubt_tag_o,
  output logic [31:0]                doubt_triangle_o,
  input  logic                       doubt_fire_i,
  // the nearest hit of a ray, in the same clock
  input  logic [RayWidth-1:0]        end_ray_i,
  output logic                       end_found_o,
  output logic [31:0]                end_triangle_o,
  output logic [31:0]                end_t_o,
  output logic [TErrorWidth-1:0]     end_t_error_o,
  output logic [TestsWidth-1:0]      end_tests_o,
  // the P of a ray's last hit that was kept, in the clock after
  input  logic [RayWidth-1:0]        point_ray_i,
  output logic [95:0]                point_o,
  // this clock's, for counters
  output logic                       near_tie_o
);

  localparam int unsigned CountWidth = 10;
  localparam logic [31:0] Infinity = 32'h7f80_0000;

  logic [30:0] t_max[Rays];
  logic [31:0] nearest_t[Rays];
  logic [TErrorWidth-1:0] nearest_error[Rays];
  logic [31:0] nearest_triangle[Rays];
  logic [TestsWidth-1:0] tests[Rays];
  logic [CountWidth-1:0] counts[Rays];  // tests on their way
  logic [Rays-1:0] found_q, any_hit_q;

  assign traversal_t_max_o   = t_max[traversal_ray_i];
  assign traversal_ended_o   = found_q[traversal_ray_i] & any_hit_q[traversal_ray_i];
  assign leaf_t_max_o        = t_max[leaf_ray_i];
  assign leaf_ended_o        = found_q[leaf_ray_i] & any_hit_q[leaf_ray_i];
  assign leaf_counter_full_o = &counts[leaf_ray_i];
  assign box_t_max_o         = t_max[box_ray_i];

  // ---- The result against the nearest so far

  logic good, hit, doubt, replace, open, old_open;
  logic [TErrorWidth-1:0] t_error;
  logic [31:0] margin, old_margin, low, high, old_low, sum, old_t, old_t_max;

  assign good = set_up_pkg::is_good_hit(TErrorWidth'(result_t_error_i), result_normal_error_i);
  assign t_error = set_up_pkg::t_error_exponent(
      TErrorWidth'(result_t_error_i), result_normal_error_i, result_distance_error_i);
  assign hit   = result_i & ~result_skipped_i & result_hit_i & good;
  assign doubt = result_i & ~result_skipped_i & (result_doubt_i | (result_hit_i & ~good));

  assign margin     = 32'd1 << t_error;
  assign old_t      = nearest_t[result_ray_i];
  assign old_margin = 32'd1 << nearest_error[result_ray_i];
  assign old_t_max  = {1'b0, t_max[result_ray_i]};
  assign low        = (result_t_i > margin) ? result_t_i - margin : '0;
  assign sum        = result_t_i + margin;
  assign high       = (sum < Infinity) ? sum : Infinity;
  assign old_low    = (old_t > old_margin) ? old_t - old_margin : '0;
  assign replace    = hit & (high < old_t_max);
  assign old_open   = replace & found_q[result_ray_i] & (old_low <= high);
  assign open       = hit & ~replace & (low <= old_t_max);
  assign near_tie_o = old_open | open;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      found_q   <= '0;
      any_hit_q <= '0;
    end else begin
      if (load_i) begin
        found_q[load_ray_i]   <= 1'b0;
        any_hit_q[load_ray_i] <= load_any_hit_i;
      end
      if (replace) found_q[result_ray_i] <= 1'b1;
    end
  end
  always_ff @(posedge clk_i) begin
    if (load_i) t_max[load_ray_i] <= load_t_max_i;
    if (replace) begin
      t_max[result_ray_i]            <= high[30:0];
      nearest_t[result_ray_i]        <= result_t_i;
      nearest_error[result_ray_i]    <= t_error;
      nearest_triangle[result_ray_i] <= result_triangle_i;
    end
  end

  // ---- Doubts

  ram_fifo #(
    .Width(32 + 32),
    .Depth(InFlight + 16),
    .Reserve(InFlight)
  ) u_doubts (
    .clk_i,
    .rst_ni,
    .push_i(doubt | open | old_open),
    .data_i({result_tag_i, old_open ? nearest_triangle[result_ray_i] : result_triangle_i}),
    .space_o(tests_allowed_o),
    .pop_i(doubt_fire_i),
    .valid_o(doubt_valid_o),
    .data_o({doubt_tag_o, doubt_triangle_o})
  );

  // ---- P: of every hit in turn, kept if the hit was

  logic point_kept, unused_point, unused_space;
  logic [RayWidth-1:0] point_ray;

  fifo #(
    .Width(RayWidth + 1),
    .Depth(InFlight)
  ) u_points (
    .clk_i,
    .rst_ni,
    .push_i(result_i & result_hit_i),
    .data_i({result_ray_i, replace}),
    .space_o(unused_space),
    .pop_i(point_valid_i),
    .valid_o(unused_point),
    .data_o({point_ray, point_kept})
  );

  ram #(
    .Width(96),
    .Depth(Rays)
  ) u_kept (
    .clk_i,
    .write_i(point_valid_i & point_kept),
    .write_address_i(point_ray),
    .data_i(point_i),
    .read_i(1'b1),
    .read_address_i(point_ray_i),
    .data_o(point_o)
  );

  // ---- Tests on their way

  logic same;
  assign same = test_i & result_i & (test_ray_i == result_ray_i);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      testing_o <= '0;
    end else begin
      if (result_i && !same && counts[result_ray_i] == CountWidth'(1)) begin
        testing_o[result_ray_i] <= 1'b0;
      end
      if (test_i) testing_o[test_ray_i] <= 1'b1;
    end
  end
  always_ff @(posedge clk_i) begin
    if (load_i) begin
      counts[load_ray_i] <= '0;
      tests[load_ray_i]  <= '0;
    end
    if (test_i) tests[test_ray_i] <= tests[test_ray_i] + 1'b1;
    if (test_i && !same) counts[test_ray_i] <= counts[test_ray_i] + 1'b1;
    if (result_i && !same) counts[result_ray_i] <= counts[result_ray_i] - 1'b1;
  end

  // ---- The end

  assign end_found_o    = found_q[end_ray_i];
  assign end_triangle_o = nearest_triangle[end_ray_i];
  assign end_t_o        = nearest_t[end_ray_i];
  assign end_t_error_o  = nearest_error[end_ray_i];
  assign end_tests_o    = tests[end_ray_i];

endmodule
