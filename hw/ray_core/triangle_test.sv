// Triangle test: polygon record of a triangle, and a ray's verdict. The record is relative to the origin; binary32.
//
// Throughput: a triangle in Clocks clocks. Latency: 48 with Clocks = 1 (clocks from triangle_i to its verdict). In this
// case, cores are pipelined. With Clocks of 7 or more, words share few cores: a step lasts from one step_i to the next,
// and registers advance once in a step. Results are the same. No stalls.
//
//   operation   cores                                                     sums and products
//   1           vertices A, B, C minus O; the edges B-A, C-B, A-C         18
//   2, 3        N = (A-C) x (B-A); A x (B-A), B x (C-B), C x (A-C);       24, 24
//               the sizes of their terms
//   4-6         d = N . A; the sums of the edges' terms, for bounds       3, 8
//   7-9         V = N . I, U_k = E_k . I, d I_k                           see hit_dots
//   then        the decision, and t = d / V, P_k = (d I_k) / V            see hit_decision; 4 dividers, or one
//
// An operation takes 3 clocks, or a step. triangle_i and the context of its ray, ctx_i, come with step_i. origin_i and
// skip_id_i and source_id_i of this ray come in the next clock and stay until the next step_i. direction_ctx_o names a
// context at each step_i: direction_i must be its direction from the next clock until the next step_i. A verdict and
// its P are valid for a clock.
//
// The record has hit_test_pkg's format. It differs in two ways from a record that a host computes in double precision:
//   * Bounds are about twice as large, because they include the errors of words computed in binary32 (see below).
//   * d is NaN if its sign is not sure, or if the errors of N or d are too large. Then there are no hits, only doubts
//     and misses that the edges decide (see hit_decision).
// The verdict's normal_error and distance_error bound the errors of N and d, if d is a number. For a hit, set_up_pkg
// computes the error of t from these and t_error.
//
// Why sure answers are right. u = 2**-24 is the unit roundoff, primes mark computed words, e(x) is the exponent of x,
// for a vector its largest one. A, B, C are relative to the origin. They and the edge vectors D (B - A, C - B, A - C)
// are rounded once, so they have a relative error of at most u.
//   Error of I . E for an edge plane E = A x D, compared with its bound:
//     E_k is a difference of two products such as A_i D_j. T_k is the sum of their magnitudes, T = T_x + T_y + T_z.
//     A product is off by three roundings, the difference by one more: |E'_k - E_k| <= 3.02 u T_k + 1.01 u |E'_k|.
//     |I_k| < 2 and |E'_k| <= T_k, so |I . E' - I . E| <= (6.04 + 2.02) u T.
//     The dot product's three roundings add 6.001 u T. The sum, 14.07 u T, and the error of T' are below 16 u T'.
//     The bound is 16 u T', which is T' with another exponent.
//   Errors of V = I . N and of d = N . A. Let M_k be for N_k what T_k is for E_k, and M the largest M_k.
//     As for edges, |N'_k - N_k| <= 3.02 u M_k + 1.01 u |N'_k|.
//     As for edges, V' is off by at most 14.07 u (M_x + M_y + M_z) < 84.5 u 2**e(M).
//     |d' - d| <= u sum |A_k| (5.04 |N_k| + 3.02 M_k) <= 8.06 u sum |A_k| M_k < 96.8 u 2**(e(A) + e(M)).
//   Error of t = d / V. Let m = e(M) - e(N') (normal_error), q = max(e(A) + e(M) - e(d), 0) (distance_error),
//     g = max(e(N') - e(V), 0) (the decision's t_error) and x = max(m + g, q).
//     V' is off by at most 84.5 u 2**(m + g) of itself. If m + g <= 14 (is_good_hit), this is at most 0.083.
//     d' is off by at most 96.8 u 2**q of itself. If q <= 14 (else plane_of makes d NaN), its sign is right.
//     With the division's rounding, t' is off by (181.3 + 1) u 2**x / (1 - 0.083) < 199 u 2**x of itself.
//     Floats near t are at least u t apart, so fewer than 2**(8 + x) lie between t' and t.
//   Underflow adds at most 2**-150 to each product. It is far below the margins of the constants, unless a size is
//     below 2**-100: then the bound is infinite, or d is NaN.
//   Overflow gives an infinity or NaN, which is never sure.
//
// Source: the paper's section 2.2 (what is computed once for an origin); the bounds are this project's.
module triangle_test
  import ray_core_pkg::*;
#(
  parameter int unsigned Rays   = 64,
  parameter int unsigned Clocks = 1,
  parameter int unsigned Arith  = arith_pkg::Graded,
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                clk_i,
  input  logic                rst_ni,
  input  logic                step_i,
  input  logic [RayWidth-1:0] ctx_i,
  // verilator lint_off UNUSEDSIGNAL
  // Ranks, and lines with `exact` high, are for exact_resolver.
  input  triangle_line_t      triangle_i,  // skipped if it has an error
  // verilator lint_on UNUSEDSIGNAL
  input  logic [95:0]         origin_i,
  input  logic [31:0]         skip_id_i,  // the ray skips triangles skip_id_i and source_id_i
  input  logic [31:0]         source_id_i,
  output logic [RayWidth-1:0] direction_ctx_o,
  input  logic [95:0]         direction_i,
  output logic [RayWidth-1:0] ctx_o,
  output verdict_t            verdict_o
);

  localparam int unsigned ErrorWidth = set_up_pkg::PlaneErrorWidth;

  if (Clocks != 1 && Clocks < 7) begin : gen_check
    $error("triangle_test: expected Clocks of 1, or 7 or more");
  end

  // Latencies in steps, which are clocks if Clocks is 1
  localparam int unsigned Operation = (Clocks == 1) ? hit_test_pkg::AdderLatency : 1;
  localparam int unsigned Take = (Clocks == 1) ? 2 : 1;  // with one for a memory's output
  localparam int unsigned Decide = Take + 9 * Operation;
  localparam int unsigned Divide = hit_test_pkg::divide_latency(set_up_pkg::FracWidth);  // clocks
  localparam int unsigned DivideSteps = (Clocks == 1) ? Divide + 1 : (Divide + 3) / Clocks + 1;
  localparam int unsigned Last = Decide + 1 + DivideSteps;

  // ---- Take; tests in flight

  logic [TriangleWidth-1:0] line_q;
  logic [RayWidth-1:0] ctx_q, ctx;
  logic [9*32-1:0] corners;
  logic [95:0] origin;
  logic [31:0] index, taken_index, early_index;
  logic [Last:1] valid_q;  // [n]: a triangle came n steps ago
  logic error_q, skipped, taken_skipped, early_skipped;

  assign index   = line_q[TriangleIndex+:32];
  assign skipped = error_q | (index == skip_id_i) | (index == source_id_i);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= '0;
    else if (step_i) valid_q <= {valid_q[Last-1:1], triangle_i.valid & ~triangle_i.exact};
  end
  always_ff @(posedge clk_i) begin
    if (step_i) {line_q, ctx_q, error_q} <= {triangle_i.line, ctx_i, triangle_i.error};
  end
  delay_line #(
    .Width(9 * 32 + 96 + RayWidth + 32 + 1),
    .Depth(Take - 1)
  ) u_take (
    .clk_i,
    .enable_i(1'b1),
    .data_i({line_q[TriangleCorners +: 9*32], origin_i, ctx_q, index, skipped}),
    .data_o({corners, origin, ctx, taken_index, taken_skipped})
  );
  delay_line #(
    .Width(RayWidth + 32 + 1),
    .Depth(6 * Operation - 1)
  ) u_early (
    .clk_i,
    .enable_i(step_i),
    .data_i({ctx, taken_index, taken_skipped}),
    .data_o({direction_ctx_o, early_index, early_skipped})
  );
  delay_line #(
    .Width(RayWidth + 32 + 1),
    .Depth(Last - Take - 6 * Operation + 1)
  ) u_late (
    .clk_i,
    .enable_i(step_i),
    .data_i({direction_ctx_o, early_index, early_skipped}),
    .data_o({ctx_o, verdict_o.triangle, verdict_o.is_skipped})
  );

  // ---- Subtract

  logic [9*32-1:0] corner, edge_vector;  // A, B, C; B-A, C-B, A-C

  fp_vector #(
    .Words(18),
    .Subtract(18'h3ffff),
    .Clocks(Clocks),
    .Arith(Arith)
  ) u_differences (
    .clk_i,
    .step_i,
    .a_i({corners[0 +: 3*32], corners[3*32 +: 6*32], corners}),
    .b_i({corners, {3{origin}}}),
    .result_o({edge_vector, corner})
  );

  // ---- Cross: the edges' planes, then N. Word k of a product is a_i b_j - a_j b_i for (i, j, k) = (1, 2, 0) and so
  // on; `terms` is |a_i b_j| + |a_j b_i|, the header's T_k and M_k

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

  fp_vector #(
    .Words(24),
    .Multiply(1'b1),
    .Clocks(Clocks),
    .Arith(Arith)
  ) u_terms (
    .clk_i,
    .step_i,
    .a_i(lefts),
    .b_i(rights),
    .result_o(cross_terms)
  );
  fp_vector #(
    .Words(24),
    .Subtract({4{6'b000111}}),
    .Clocks(Clocks),
    .Arith(Arith)
  ) u_cross (
    .clk_i,
    .step_i,
    .a_i(minuends),
    .b_i(others),
    .result_o(differences)
  );

  // ---- Sum: x + y, then + z, of the edges' terms (for the bounds) and of d. Bounds are ready an operation before d

  logic [95:0] vertex, shares, last_terms, early_bounds, bounds;  // shares: N_k A_k
  logic [31:0] last_share, d, good_d;
  logic [8*32-1:0] sums;
  logic [12*32-1:0] planes;
  logic [23:0] fields;
  set_up_pkg::plane_t plane;

  delay_line #(
    .Width(96),
    .Depth(2 * Operation)
  ) u_vertex (
    .clk_i,
    .enable_i(step_i),
    .data_i(corner[95:0]),
    .data_o(vertex)
  );
  fp_vector #(
    .Multiply(1'b1),
    .Clocks(Clocks),
    .Arith(Arith)
  ) u_shares (
    .clk_i,
    .step_i,
    .a_i(product[9*32 +: 96]),
    .b_i(vertex),
    .result_o(shares)
  );
  for (genvar k = 0; k < 3; k++) begin : gen_bound
    assign early_bounds[32*k+:32] = set_up_pkg::bound(sums[32*(3+k)+:32]);
  end
  delay_line #(
    .Width(2 * 96 + 32),
    .Depth(Operation)
  ) u_thirds (
    .clk_i,
    .enable_i(step_i),
    .data_i({terms[32*8 +: 32], terms[32*5 +: 32], terms[32*2 +: 32], shares[95:64], early_bounds}),
    .data_o({last_terms, last_share, bounds})
  );
  fp_vector #(
    .Words(8),
    .Clocks(Clocks),
    .Arith(Arith)
  ) u_sums (
    .clk_i,
    .step_i,
    .a_i({sums[32*6 +: 32], shares[31:0], sums[95:0],
          terms[32*6 +: 32], terms[32*3 +: 32], terms[0 +: 32]}),
    .b_i({last_share, shares[63:32], last_terms,
          terms[32*7 +: 32], terms[32*4 +: 32], terms[32*1 +: 32]}),
    .result_o(sums)
  );
  assign d = sums[32*7+:32];

  // The plane's errors follow from exponents. Those of A, of N and of N's terms are delayed until d is there
  delay_line #(
    .Width(12 * 32 + 24),
    .Depth(3 * Operation)
  ) u_planes (
    .clk_i,
    .enable_i(step_i),
    .data_i({set_up_pkg::largest(vertex), set_up_pkg::largest(product[9*32 +: 96]),
             set_up_pkg::largest(terms[9*32 +: 96]), product}),
    .data_o({fields, planes})
  );
  assign plane  = set_up_pkg::plane_of(fields[23:16], fields[15:8], fields[7:0], d[30:23]);
  assign good_d = plane.good ? d : set_up_pkg::NaN;

  // ---- V, U_k and the decision

  logic [31:0] v, decided_d;
  logic [95:0] u, dividends, decided_bounds;
  logic [7:0] decided_exponent;
  logic [2*ErrorWidth-1:0] decided_errors;
  logic hit, doubt, late_hit, late_doubt;
  logic [hit_test_pkg::TErrorWidth-1:0] t_error;

  hit_dots #(
    .Clocks(Clocks),
    .Arith(Arith)
  ) u_dots (
    .clk_i,
    .step_i,
    .normal_i(planes[9*32 +: 96]),
    .edges_i(planes[0 +: 9*32]),
    .d_i(good_d),
    .direction_i,
    .v_o(v),
    .u_o(u),
    .dividends_o(dividends)
  );
  delay_line #(
    .Width(32 + 96 + 8 + 2 * ErrorWidth),
    .Depth(3 * Operation)
  ) u_decided (
    .clk_i,
    .enable_i(step_i),
    .data_i({good_d, bounds, fields[15:8], plane.normal_error, plane.distance_error}),
    .data_o({decided_d, decided_bounds, decided_exponent, decided_errors})
  );
  hit_decision u_decision (
    .d_i(decided_d),
    .normal_exponent_i(decided_exponent),
    .v_i(v),
    .u_i(u),
    .bounds_i(decided_bounds),
    .miss_o(),
    .hit_o(hit),
    .doubt_o(doubt),
    .t_error_o(t_error)
  );
  delay_line #(
    .Width(2 + hit_test_pkg::TErrorWidth + 2 * ErrorWidth),
    .Depth(Last - Decide)
  ) u_verdict (
    .clk_i,
    .enable_i(step_i),
    .data_i({hit, doubt, t_error, decided_errors}),
    .data_o({late_hit, late_doubt, verdict_o.t_error, verdict_o.normal_error,
             verdict_o.distance_error})
  );

  // ---- Divide: four dividers compute t and P at once; a single one computes t, then P's words

  localparam int unsigned Dividers = (Clocks == 1) ? 4 : 1;
  logic [4*32-1:0] dividends_q, quotients_q;
  logic [Dividers*32-1:0] quotients;
  logic [31:0] divisor_q;
  logic divide;

  for (genvar k = 0; k < Dividers; k++) begin : gen_divider
    fp_divider #(
      .Arith(Arith),
      .Pipelined(1'b1)
    ) u_divider (
      .clk_i,
      .valid_i(divide),
      .a_i(dividends_q[32*k +: 32]),
      .b_i(divisor_q),
      .rounding_mode_i(fp_pkg::RoundNearestEven),
      .tininess_after_i(1'b0),
      .result_o(quotients[32*k +: 32]),
      .flags_o()
    );
  end

  if (Clocks == 1) begin : gen_at_once
    logic hit_q;

    always_ff @(posedge clk_i) begin
      {dividends_q, divisor_q, hit_q} <= {dividends, decided_d, v, hit};
      quotients_q <= quotients;
    end
    assign divide          = valid_q[Decide+1] & hit_q;
    assign verdict_o.valid = valid_q[Last];
  end else begin : gen_turns
    localparam int unsigned Wait = DivideSteps * Clocks - 1 - Divide;  // from t to the step
    logic [3:0] since_q;  // [n]: step_i was high n + 1 clocks ago
    logic [Wait*32-1:0] waiting_q;
    logic [(Wait+1)*32-1:0] waiting;  // the latest is highest

    assign waiting = {quotients, waiting_q};

    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) since_q <= '0;
      else since_q <= {since_q[2:0], step_i};
    end
    always_ff @(posedge clk_i) begin
      dividends_q <= step_i ? {dividends, decided_d} : dividends_q >> 32;
      if (step_i) divisor_q <= v;
      waiting_q <= waiting[(Wait+1)*32-1:32];
      if (step_i) quotients_q <= waiting[4*32-1:0];
    end
    assign divide          = |since_q;
    assign verdict_o.valid = valid_q[Last] & since_q[0];
  end

  // ---- The verdict: a hit whose t is not a positive normal number is a doubt

  logic is_normal;
  assign {verdict_o.point, verdict_o.t} = quotients_q;
  assign is_normal = ~quotients_q[31] & (quotients_q[30:23] != '0) & ~(&quotients_q[30:23]);
  assign verdict_o.found = late_hit & is_normal;
  assign verdict_o.doubt = late_doubt | (late_hit & ~is_normal);

endmodule
