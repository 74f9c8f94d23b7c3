// Triangle test in few floating-point cores that take turns: what triangle_test says, bit for bit, of a triangle in Clocks
// clocks. set_up_unit's and hit_test_pipeline's headers say what is computed, and why sure answers are sure.
//
// A step is from one step_i to the next, Clocks clocks; all registers below go on with it. A triangle comes with step_i
// only. The ray is given by its context: origin_i and both ids from the clock after that until the next step_i, its
// direction likewise after the step_i with direction_ctx_o. Verdicts are there for a clock; a hit's P two clocks later.
// Latency: 10 steps, as many as 22 clocks take, and a clock.
//
//   step   what comes in                                              cores
//   1      vertices - O, the edges                                    18 sums
//   2, 3   N, the three edge planes, their terms                      24 products, 24 sums
//   4-7    d = N . A, the edges' bounds                               3 products, 8 sums
//   7      N, E_k, d times I                                          15 products
//   8, 9   V = N . I, U_k = E_k . I                                   8 sums
//   10     the decision; t = d / V, P_k = (d I_k) / V                 a divider for all four, see fp_vector_divider
module shared_triangle_test #(
  parameter int unsigned Rays   = 16,
  parameter int unsigned Clocks = 11,  // at least 7
  parameter int unsigned Arith  = arith_pkg::Structural,
  parameter int unsigned Adder  = arith_pkg::AdderGraded,
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                       clk_i,
  input  logic                       rst_ni,
  input  logic                       step_i,
  input  logic [RayWidth-1:0]        ctx_i,
  // verilator lint_off UNUSEDSIGNAL
  // Ranks are exact_resolver's, and so are lines that are `exact`.
  input  ray_core_pkg::triangle_line_t triangle_i,  // with an error it counts for nothing
  // verilator lint_on UNUSEDSIGNAL
  input  logic [95:0]                origin_i,
  input  logic [31:0]                skip_id_i,  // triangles that count for nothing
  input  logic [31:0]                source_id_i,
  output logic [RayWidth-1:0]        direction_ctx_o,
  input  logic [95:0]                direction_i,
  output logic [RayWidth-1:0]        ctx_o,
  output ray_core_pkg::verdict_t     verdict_o
);

  if (Clocks < 7) begin : gen_check
    $error("shared_triangle_test: expected 7 Clocks or more");
  end

  localparam int unsigned Decide = 10;  // the step
  // fp_vector_divider's clocks from V to t; P's words follow t
  localparam int unsigned Divide = (23 + 2) / 2 + 6;
  localparam int unsigned DivideSteps = (Divide + 3) / Clocks + 1;
  localparam int unsigned Wait = DivideSteps * Clocks - 1 - Divide;  // from t to the step
  localparam int unsigned Last = Decide + DivideSteps;

  // ---- Take; which test is where

  logic [ray_core_pkg::TriangleWidth-1:0] triangle_q;
  logic [RayWidth-1:0] ctx_q;
  logic [31:0] index, verdict_triangle;
  logic [Last:0] valid_q;  // with the step of this number the test goes on
  logic [4:0] since_q;  // the clock after the step, and those after it
  logic error_q, skipped, early_skipped, verdict_skipped;
  logic [31:0] early_triangle;

  assign index   = triangle_q[ray_core_pkg::TriangleIndex+:32];
  assign skipped = error_q | (index == skip_id_i) | (index == source_id_i);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) {valid_q, since_q} <= '0;
    else begin
      since_q <= {since_q[3:0], step_i};
      if (step_i) valid_q <= {valid_q[Last-1:0], triangle_i.valid & ~triangle_i.exact};
    end
  end
  always_ff @(posedge clk_i) begin
    if (step_i) {triangle_q, ctx_q, error_q} <= {triangle_i.line, ctx_i, triangle_i.error};
  end
  delay_line #(
    .Width(RayWidth + 32 + 1),
    .Depth(5)
  ) u_early (
    .clk_i,
    .enable_i(step_i),
    .data_i({ctx_q, index, skipped}),
    .data_o({direction_ctx_o, early_triangle, early_skipped})
  );
  delay_line #(
    .Width(RayWidth + 32 + 1),
    .Depth(Last - 5)
  ) u_late (
    .clk_i,
    .enable_i(step_i),
    .data_i({direction_ctx_o, early_triangle, early_skipped}),
    .data_o({ctx_o, verdict_triangle, verdict_skipped})
  );

  // ---- Subtract

  logic [9*32-1:0] corners, corner, edge_vector;
  assign corners = triangle_q[ray_core_pkg::TriangleCorners+:9*32];

  fp_vector_adder #(
    .Words(18),
    .Subtract(18'h3ffff),
    .Clocks(Clocks),
    .Arith(Arith),
    .Adder(Adder)
  ) u_differences (
    .clk_i,
    .step_i,
    .a_i({corners[0 +: 3*32], corners[3*32 +: 6*32], corners}),
    .b_i({corners, {3{origin_i}}}),
    .sum_o({edge_vector, corner})
  );

  // ---- Cross: the edges' planes, then N; see cross_product

  logic [4*192-1:0] lefts, rights, cross_terms, minuends, others, differences;
  logic [12*32-1:0] product, terms;

  for (genvar n = 0; n < 4; n++) begin : gen_cross
    localparam logic [95:0] Magnitudes = {3{32'h7fff_ffff}};
    logic [95:0] a, b, left, right;
    assign a = (n < 3) ? corner[96*(n%3)+:96] : edge_vector[96*2+:96];
    assign b = edge_vector[96*(n%3)+:96];
    assign lefts[192*n+:192]  = {a[63:0], a[95:64], a[31:0], a[95:32]};
    assign rights[192*n+:192] = {b[31:0], b[95:32], b[63:0], b[95:64]};
    assign {right, left} = cross_terms[192*n+:192];
    assign minuends[192*n+:192] = {left & Magnitudes, left};
    assign others[192*n+:192]   = {right & Magnitudes, right};
    assign {terms[96*n+:96], product[96*n+:96]} = differences[192*n+:192];
  end

  fp_vector_multiplier #(
    .Words(24),
    .Clocks(Clocks),
    .Arith(Arith),
    .Adder(Adder)
  ) u_terms (
    .clk_i,
    .step_i,
    .a_i(lefts),
    .b_i(rights),
    .product_o(cross_terms)
  );
  fp_vector_adder #(
    .Words(24),
    .Subtract({4{6'b000111}}),
    .Clocks(Clocks),
    .Arith(Arith),
    .Adder(Adder)
  ) u_cross (
    .clk_i,
    .step_i,
    .a_i(minuends),
    .b_i(others),
    .sum_o(differences)
  );

  // ---- Sum: bounds at step 6, d at step 7

  logic [95:0] vertex, shares, last_terms, bounds_early, bounds;
  logic [31:0] last_share, d, good_d;
  logic [8*32-1:0] sums;
  logic [12*32-1:0] planes;
  logic [23:0] fields;
  set_up_pkg::plane_t plane;

  delay_line #(
    .Width(96),
    .Depth(2)
  ) u_vertex (
    .clk_i,
    .enable_i(step_i),
    .data_i(corner[95:0]),
    .data_o(vertex)
  );
  fp_vector_multiplier #(
    .Words(3),
    .Clocks(Clocks),
    .Arith(Arith),
    .Adder(Adder)
  ) u_shares (
    .clk_i,
    .step_i,
    .a_i(product[9*32 +: 96]),
    .b_i(vertex),
    .product_o(shares)
  );
  always_ff @(posedge clk_i) begin
    if (step_i) begin
      last_terms <= {terms[32*8+:32], terms[32*5+:32], terms[32*2+:32]};
      last_share <= shares[95:64];
      bounds     <= bounds_early;
    end
  end
  // x + y of the edges' terms, then + z; x + y of d, then + z
  fp_vector_adder #(
    .Words(8),
    .Clocks(Clocks),
    .Arith(Arith),
    .Adder(Adder)
  ) u_sums (
    .clk_i,
    .step_i,
    .a_i({sums[32*6 +: 32], shares[31:0], sums[95:0],
          terms[32*6 +: 32], terms[32*3 +: 32], terms[0 +: 32]}),
    .b_i({last_share, shares[63:32], last_terms,
          terms[32*7 +: 32], terms[32*4 +: 32], terms[32*1 +: 32]}),
    .sum_o(sums)
  );
  for (genvar k = 0; k < 3; k++) begin : gen_bound
    assign bounds_early[32*k+:32] = set_up_pkg::bound(sums[32*(3+k)+:32]);
  end
  assign d = sums[32*7+:32];

  delay_line #(
    .Width(12 * 32 + 24),
    .Depth(3)
  ) u_planes (
    .clk_i,
    .enable_i(step_i),
    .data_i({set_up_pkg::largest(vertex), set_up_pkg::largest(product[9*32 +: 96]),
             set_up_pkg::largest(terms[9*32 +: 96]), product}),
    .data_o({fields, planes})
  );
  assign plane  = set_up_pkg::plane_of(fields[23:16], fields[15:8], fields[7:0], d[30:23]);
  assign good_d = plane.good ? d : set_up_pkg::NaN;

  // ---- Scale and add: V, then U_k

  localparam int unsigned Scaled = 5;  // words of a coordinate: N's, E_k's, d
  logic [3*Scaled*32-1:0] words, factors, scaled;
  logic [8*32-1:0] dots;
  logic [4*32-1:0] last_scaled;
  logic [95:0] dividends;

  for (genvar k = 0; k < 3; k++) begin : gen_coordinate
    assign words[32*Scaled*k+:32*Scaled] = {
      good_d, planes[32*(6+k)+:32], planes[32*(3+k)+:32], planes[32*k+:32], planes[32*(9+k)+:32]
    };
    assign factors[32*Scaled*k+:32*Scaled] = {Scaled{direction_i[32*k+:32]}};
  end

  fp_vector_multiplier #(
    .Words(3 * Scaled),
    .Clocks(Clocks),
    .Arith(Arith),
    .Adder(Adder)
  ) u_scale (
    .clk_i,
    .step_i,
    .a_i(words),
    .b_i(factors),
    .product_o(scaled)
  );
  always_ff @(posedge clk_i) if (step_i) last_scaled <= scaled[32*2*Scaled+:4*32];
  fp_vector_adder #(
    .Words(8),
    .Clocks(Clocks),
    .Arith(Arith),
    .Adder(Adder)
  ) u_dots (
    .clk_i,
    .step_i,
    .a_i({dots[4*32-1:0], scaled[0 +: 4*32]}),
    .b_i({last_scaled, scaled[32*Scaled +: 4*32]}),
    .sum_o(dots)
  );
  delay_line #(
    .Width(96),
    .Depth(2)
  ) u_dividends (
    .clk_i,
    .enable_i(step_i),
    .data_i({scaled[32*14 +: 32], scaled[32*9 +: 32], scaled[32*4 +: 32]}),
    .data_o(dividends)
  );

  // ---- Decide

  localparam int unsigned ErrorWidth = set_up_pkg::PlaneErrorWidth;
  logic [31:0] decided_d;
  logic [95:0] decided_bounds;
  logic [7:0] decided_exponent;
  logic [2*ErrorWidth-1:0] decided_errors;
  logic unused_miss, hit, doubt, late_hit, late_doubt;
  logic [hit_test_pkg::TErrorWidth-1:0] t_error;

  delay_line #(
    .Width(32 + 96 + 8 + 2 * ErrorWidth),
    .Depth(3)
  ) u_decided (
    .clk_i,
    .enable_i(step_i),
    .data_i({good_d, bounds, fields[15:8], plane.normal_error, plane.distance_error}),
    .data_o({decided_d, decided_bounds, decided_exponent, decided_errors})
  );
  hit_decision u_decision (
    .d_i(decided_d),
    .normal_exponent_i(decided_exponent),
    .v_i(dots[4*32 +: 32]),
    .u_i(dots[5*32 +: 96]),
    .bounds_i(decided_bounds),
    .miss_o(unused_miss),
    .hit_o(hit),
    .doubt_o(doubt),
    .t_error_o(t_error)
  );
  delay_line #(
    .Width(2 + hit_test_pkg::TErrorWidth + 2 * ErrorWidth),
    .Depth(DivideSteps + 1)
  ) u_verdict (
    .clk_i,
    .enable_i(step_i),
    .data_i({hit, doubt, t_error, decided_errors}),
    .data_o({late_hit, late_doubt, verdict_o.t_error, verdict_o.normal_error,
             verdict_o.distance_error})
  );

  // ---- Divide: V, then d and d I_k

  logic [5*32-1:0] divided_q;
  logic [31:0] quotient;
  logic unused_valid;
  logic [31:0] t_q;
  logic [95:0] point_q;
  logic [Wait*32-1:0] quotients_q;
  logic [(Wait+1)*32-1:0] quotients;  // the latest highest

  assign quotients = {quotient, quotients_q};

  fp_vector_divider #(
    .Arith(Arith),
    .Adder(Adder),
    .Components(4),
    .Period(Clocks),
    .RowsPerClock(1)
  ) u_divider (
    .clk_i,
    .rst_ni,
    .divisor_i(since_q[0]),
    .dividend_i(|since_q[4:1]),
    .word_i(divided_q[31:0]),
    .rounding_mode_i(fp_pkg::RoundNearestEven),
    .valid_o(unused_valid),
    .result_o(quotient)
  );
  always_ff @(posedge clk_i) begin
    divided_q   <= step_i ? {dividends, decided_d, dots[4*32+:32]} : divided_q >> 32;
    quotients_q <= quotients[(Wait+1)*32-1:32];
    if (step_i) {point_q, t_q} <= quotients[4*32-1:0];
  end

  // ---- The verdict: a t that is no positive normal number is none

  logic normal, found;
  assign normal = ~t_q[31] & (t_q[30:23] != '0) & ~(&t_q[30:23]);
  assign found  = late_hit & normal;
  assign verdict_o.valid       = valid_q[Last] & since_q[0];
  assign verdict_o.is_skipped  = verdict_skipped;
  assign verdict_o.triangle    = verdict_triangle;
  assign verdict_o.found       = found;
  assign verdict_o.t           = t_q;
  assign verdict_o.point       = point_q;
  assign verdict_o.doubt       = late_doubt | (late_hit & ~normal);
  assign verdict_o.point_valid = valid_q[Last] & since_q[2] & found;

endmodule
