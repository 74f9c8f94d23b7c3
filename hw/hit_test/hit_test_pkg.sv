// Shared by the pipelined hit-test units: the layout of a record and of a result.
//
// Words are IEEE numbers of one format, packed into flat vectors with word 0 lowest.
package hit_test_pkg;

  // verilator lint_off UNUSEDPARAM
  // No top module uses everything.

  // ---- Polygon record: 16 words, one triangle seen from one origin (A, B, C: vertices - origin)

  localparam int unsigned RecordWords = 16;
  localparam int unsigned RecordNormal = 0;  // 0-2: N = (B-A) x (C-A)
  localparam int unsigned RecordD = 3;  // N . A; 0: no ray hits
  localparam int unsigned RecordEdges = 4;  // 4-12: the edge planes A x B, B x C, C x A
  localparam int unsigned RecordBounds = 13;  // 13-15: error bounds of the edge tests

  // ---- Reports on a single test

  typedef enum logic [1:0] {
    ReportNone    = 2'd0,
    ReportDoubt   = 2'd1,  // neither surely hit nor surely missed, or t out of range
    ReportNearTie = 2'd2   // a sure hit that may or may not be nearer than the nearest hit
  } report_e;

  // ---- Error of t = d / V, computed: at most 2**(TErrorUnit + t_error) units in its last place
  //
  // Let u = 2**-(FracWidth+1), e(x) the exponent of x, e(N) the largest e(N_k), V = fl(N . I) and g = e(N) - e(V).
  // Error of V: |I_k| < 2, N and d have relative errors up to 1.01 u, a dot product rounds three times. So V is off by
  // at most 4.04 u * 2 (|N_x| + |N_y| + |N_z|) < 48.5 u 2**e(N). Relative to V: at most r = 48.5 u 2**g.
  // Error of t: d adds a relative error below 2 u, the division u. Floats near t are at least u t apart. So at most
  // (48.5 * 2**g + 3.2) / (1 - r) of them lie between t and the exact t. This is below 2**(6 + max(g, 0)) while r <=
  // 0.19. That holds for all g up to max_grazing, if FracWidth >= 7. (With a larger g, the ray grazes the plane, and
  // the test is a doubt.)
  // This holds for RoundNearestEven; the other modes have twice the error.
  localparam int unsigned TErrorUnit = 6;
  localparam int unsigned TErrorWidth = 4;

  function automatic int unsigned max_grazing(int unsigned frac_width);
    max_grazing = (frac_width > 11) ? frac_width - 11 : 0;
  endfunction

  // ---- Latencies of the pipelined cores

  localparam int unsigned MultiplierLatency = 3;
  localparam int unsigned AdderLatency = 3;
  localparam int unsigned DotLatency = MultiplierLatency + 2 * AdderLatency;

  // Returns the latency of fp_divider: a row for every two bits of the quotient, and five stages around the rows.
  function automatic int unsigned divide_latency(int unsigned frac_width);
    divide_latency = (frac_width + 2) / 2 + 5;
  endfunction

  // Returns the clocks from the edge that takes a test to the edge after which its P, if any, leaves the dividers.
  function automatic int unsigned point_latency(int unsigned frac_width);
    point_latency = DotLatency + 2 * divide_latency(frac_width) + 3;
  endfunction

  // ---- Counters of hit_test_array, by the number that selects them

  typedef enum logic [3:0] {
    CountTests          = 4'd0,  // tests taken
    CountMisses         = 4'd1,
    CountHits           = 4'd2,  // sure hits, near ties included
    CountDoubts         = 4'd3,
    CountNearTies       = 4'd4,
    CountDistances      = 4'd5,  // divisions for t
    CountPoints         = 4'd6,  // points P, three divisions each
    CountIdleClocks     = 4'd7,  // clocks in which a lane could have taken a test, but none came
    CountOutputStalls   = 4'd8   // clocks in which a lane's ready_o was low
  } count_e;

  localparam int unsigned NumCounts = 9;

  // verilator lint_on UNUSEDPARAM

endpackage
