// Triangle set-up: the polygon record of a triangle, seen from a ray's origin, in binary32; the paper's pre-processing.
// Latency: set_up_pkg::Latency, throughput one triangle a clock. Takes every bit pattern.
//
//   subtract  A, B, C: vertices - O; the edges B-A, C-B, A-C      18 adders
//   cross     N = (A-C) x (B-A); A x (B-A), B x (C-B), C x (A-C)  24 multipliers, 24 adders, see cross_product
//   sum       d = N . A; the edges' terms, for their bounds        3 multipliers, 8 adders, see fp_add3
//
// The record is hit_test_pkg's, with two differences from one that a host makes in double:
//   * bounds are those of words computed here, below, about twice as large;
//   * d is NaN where its sign is not sure, or where N or d are too far off: the plane then gives no hit,
//     only misses that the edges decide, and doubts (see hit_decision).
// normal_error_o and distance_error_o say how far off N and d are, where d is a number. For a hit,
// set_up_pkg makes of them and of the unit's t_error how far off t is.
//
// Why sure answers are sure. Let u = 2**-24, primes mark computed words, e(x) be exponents.
//   Subtracting rounds once: A' = A (1 + u), D' = D (1 + u), with |u| standing for any error up to it.
//   An edge E = A x D.  Its terms p = A'_i D'_j are off by three roundings, their difference by one more:
//     |E'_k - E_k| <= 3.02 u T_k + 1.01 u |E'_k|, where T_k = |p| + |p'| >= |E'_k| are its terms.
//     I has components below 2, so |I . E' - I . E| <= (6.04 + 2.02) u T for T = T_x + T_y + T_z, and the
//     dot product's three roundings add 6.001 u T. The sum, 14.07 u T, and what T' is off by, are below
//     bound = 16 u T', a change of the exponent alone.
//   The plane.  With M_k = N's terms as T_k are E's:  |N'_k - N_k| <= 3.02 u M_k + 1.01 u |N'_k|, and V = I . N'
//     is off by at most 14.07 u (M_x + M_y + M_z) < 84.5 u 2**e(M), the largest of the M_k meant.
//     d = N . A:  |d' - d| <= u sum |A_k| (5.04 |N_k| + 3.02 M_k) <= 8.06 u sum |A_k| M_k < 96.8 u 2**(e(A) + e(M)).
//     With normal_error = m = e(M) - e(N'), distance_error = q = max(e(A) + e(M) - e(d), 0), and the unit's
//     g = max(e(N') - e(V), 0), that is at most 84.5 u 2**(m + g) of V and 96.8 u 2**q of d. So d has the right
//     sign while q <= 14; and while m + g <= 14, V is off by at most 0.083 of itself, and t by
//     (181.3 + 1) u 2**x / (1 - 0.083) < 199 u 2**x of itself, with x = max(m + g, q). Numbers are no closer
//     than u of their size, so fewer than 2**(8 + x) of them lie between t' and t.
//   Underflow adds at most 2**-150 to each product. Bounds are infinite, or d NaN, where a size that counts is
//   below 2**-100: else that is far below the room that the constants leave.
//   Overflow gives an infinity or NaN, which is never sure.
//
// Source: the paper's section 2.2 (what is computed once for an origin); the bounds are this project's.
module set_up_unit #(
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned Width = set_up_pkg::Width,
  localparam int unsigned RecordWords = hit_test_pkg::RecordWords,
  localparam int unsigned PlaneErrorWidth = set_up_pkg::PlaneErrorWidth
) (
  input  logic                         clk_i,
  input  logic [3*Width-1:0]           origin_i,
  input  logic [9*Width-1:0]           corners_i,  // A, B, C; x, y, z of each, A.x lowest
  output logic [RecordWords*Width-1:0] record_o,
  output logic [PlaneErrorWidth-1:0]   normal_error_o,
  output logic [PlaneErrorWidth-1:0]   distance_error_o
);

  localparam int unsigned ExpWidth = set_up_pkg::ExpWidth;
  localparam int unsigned FracWidth = set_up_pkg::FracWidth;
  localparam int unsigned AdderLatency = hit_test_pkg::AdderLatency;
  localparam int unsigned CrossLatency = hit_test_pkg::MultiplierLatency + AdderLatency;
  localparam int unsigned SumLatency = 2 * AdderLatency;
  localparam int unsigned DotLatency = hit_test_pkg::DotLatency;

  if (set_up_pkg::Latency != AdderLatency + CrossLatency + DotLatency) begin : gen_check
    $error("set_up_unit: expected set_up_pkg::Latency to be the sum of the cores' latencies");
  end

  // ---- Subtract

  logic [9*Width-1:0] corner;  // A, B, C
  logic [9*Width-1:0] edge_vector;  // B-A, C-B, A-C

  vec_add #(
    .Words(18),
    .Subtract(1'b1),
    .Arith(Arith),
    .Adder(Adder)
  ) u_differences (
    .clk_i,
    .a_i({corners_i[0 +: 3*Width], corners_i[3*Width +: 6*Width], corners_i}),
    .b_i({corners_i, {3{origin_i}}}),
    .sum_o({edge_vector, corner})
  );

  // ---- Cross: three edge planes, then the triangle's plane

  logic [12*Width-1:0] product;  // of the edges, and N
  logic [9*Width-1:0] terms;
  logic [3*Width-1:0] normal_terms;

  cross_product #(
    .Arith(Arith),
    .Adder(Adder)
  ) u_normal (
    .clk_i,
    .a_i(edge_vector[6*Width +: 3*Width]),
    .b_i(edge_vector[0 +: 3*Width]),
    .product_o(product[9*Width +: 3*Width]),
    .terms_o(normal_terms)
  );
  for (genvar k = 0; k < 3; k++) begin : gen_edge
    cross_product #(
      .Arith(Arith),
      .Adder(Adder)
    ) u_edge (
      .clk_i,
      .a_i(corner[3*Width*k +: 3*Width]),
      .b_i(edge_vector[3*Width*k +: 3*Width]),
      .product_o(product[3*Width*k +: 3*Width]),
      .terms_o(terms[3*Width*k +: 3*Width])
    );
  end

  logic [3*Width-1:0] vertex;  // A, beside the cross products

  delay_line #(
    .Width(3 * Width),
    .Depth(CrossLatency)
  ) u_vertex (
    .clk_i,
    .enable_i(1'b1),
    .data_i(corner[0 +: 3*Width]),
    .data_o(vertex)
  );

  // ---- Sum: d, and the terms of each edge

  logic [3*Width-1:0] shares;  // N_k A_k
  logic [Width-1:0] d;
  logic [3*Width-1:0] sums;

  vec_mul #(
    .Arith(Arith),
    .Adder(Adder)
  ) u_shares (
    .clk_i,
    .a_i(product[9*Width +: 3*Width]),
    .b_i(vertex),
    .product_o(shares)
  );
  for (genvar k = 0; k < 3; k++) begin : gen_sum
    fp_add3 #(
      .Arith(Arith),
      .Adder(Adder)
    ) u_terms (
      .clk_i,
      .x_i(terms[Width*3*k +: Width]),
      .y_i(terms[Width*(3*k+1) +: Width]),
      .z_i(terms[Width*(3*k+2) +: Width]),
      .sum_o(sums[Width*k +: Width])
    );
  end

  fp_add3 #(
    .Arith(Arith),
    .Adder(Adder)
  ) u_d (
    .clk_i,
    .x_i(shares[0 +: Width]),
    .y_i(shares[Width +: Width]),
    .z_i(shares[2*Width +: Width]),
    .sum_o(d)
  );

  // ---- Bounds

  logic [3*Width-1:0] bounds;

  for (genvar k = 0; k < 3; k++) begin : gen_bound
    assign bounds[Width*k+:Width] = set_up_pkg::bound(sums[Width*k+:Width]);
  end

  // ---- The plane's errors, from exponents: those of A, N and M go beside d

  logic [ExpWidth-1:0] vertex_field, normal_field, terms_field;
  logic [ExpWidth-1:0] sideband_vertex, sideband_normal, sideband_terms;

  assign vertex_field = set_up_pkg::largest(vertex);
  assign normal_field = set_up_pkg::largest(product[9*Width +: 3*Width]);
  assign terms_field  = set_up_pkg::largest(normal_terms);

  logic unused;  // of N's terms only the size matters
  assign unused = ^normal_terms;

  delay_line #(
    .Width(3 * ExpWidth),
    .Depth(DotLatency)
  ) u_fields (
    .clk_i,
    .enable_i(1'b1),
    .data_i({vertex_field, normal_field, terms_field}),
    .data_o({sideband_vertex, sideband_normal, sideband_terms})
  );

  set_up_pkg::plane_t plane;

  assign plane = set_up_pkg::plane_of(
      sideband_vertex, sideband_normal, sideband_terms, d[FracWidth +: ExpWidth]);
  assign normal_error_o   = plane.normal_error;
  assign distance_error_o = plane.distance_error;

  // ---- The record: edges and N beside their sums

  logic [12*Width-1:0] planes;  // the edges, N
  logic [3*Width-1:0] delayed_bounds;

  delay_line #(
    .Width(12 * Width),
    .Depth(DotLatency)
  ) u_planes (
    .clk_i,
    .enable_i(1'b1),
    .data_i(product),
    .data_o(planes)
  );
  delay_line #(
    .Width(3 * Width),
    .Depth(DotLatency - SumLatency)
  ) u_bounds (
    .clk_i,
    .enable_i(1'b1),
    .data_i(bounds),
    .data_o(delayed_bounds)
  );

  assign record_o[Width*hit_test_pkg::RecordNormal +: 3*Width] = planes[9*Width +: 3*Width];
  assign record_o[Width*hit_test_pkg::RecordD +: Width]        = plane.good ? d : set_up_pkg::NaN;
  assign record_o[Width*hit_test_pkg::RecordEdges +: 9*Width]  = planes[0 +: 9*Width];
  assign record_o[Width*hit_test_pkg::RecordBounds +: 3*Width] = delayed_bounds;

endmodule
