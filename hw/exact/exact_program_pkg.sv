// Micro-programs of the exact unit: the polynomials whose signs it takes, instruction by instruction.
//
// An instruction computes a number from floats or earlier numbers, or the sign of a number. A digit cannot be read
// before its last product has passed the pipeline (sim/checks/exact_checks.sv checks this). So instructions for
// independent vectors alternate, or an instruction has a fence: it waits until all earlier results are written.
//
// Programs: Hit decides whether the ray hits; Limit and Order compare the hit's t. One of these two can follow Hit.
package exact_program_pkg;

  // Programs are indexed from left to right; no top module uses everything.
  // verilator lint_off LITENDIAN
  // verilator lint_off UNUSEDPARAM
  // verilog_lint: waive-start packed-dimensions-range-ordering

  import exact_pkg::*;

  typedef instruction_t [0:2] vector_t;  // instructions for x, y, z
  typedef logic [NumberWidth-1:0] place_t;  // a float in a request, or a number in memory

  // ---- Places of floats and numbers; a vector's place is that of its x

  localparam place_t Origin = place_t'(PlaceOrigin);
  localparam place_t Triangle = place_t'(PlaceTriangle);  // its corners A, B, C
  localparam place_t Other = place_t'(PlaceOther);
  localparam place_t Zero = '1;

  localparam place_t I = 5'd0;  // the direction
  localparam place_t A = 5'd3;
  localparam place_t B = 5'd6;
  localparam place_t C = 5'd9;
  localparam place_t N = place_t'(Normal);
  localparam place_t M = place_t'(SecondNormal);
  localparam place_t T = place_t'(Distance);  // a hit's t is T / S, another hit's OtherT / OtherS
  localparam place_t S = T + 5'd1;
  localparam place_t OtherT = place_t'(OtherDistance);
  localparam place_t OtherS = OtherT + 5'd1;

  // ---- Instructions

  // Returns an instruction for the number `result`: floats x0 - y0, or a sum of products (signs: kind_e).
  function automatic instruction_t number(kind_e kind, place_t result, place_t x0, place_t y0,
                                          place_t x1 = '0, place_t y1 = '0, place_t x2 = '0,
                                          place_t y2 = '0);
    number = '{kind, 1'b0, 1'b0, 1'b0, result, y2, x2, y1, x1, y0, x0};
  endfunction

  // Returns instructions for the three components of a difference of vectors of floats.
  function automatic vector_t difference(place_t result, place_t minuend, place_t subtrahend);
    for (logic [4:0] k = 0; k < 3; k++) begin
      difference[k] = number(KindCoordinate, result + k, minuend + k, subtrahend + k);
    end
  endfunction

  // Returns instructions that convert the direction's floats to numbers.
  function automatic vector_t direction();
    for (logic [4:0] k = 0; k < 3; k++) begin
      direction[k] = number(KindRay, I + k, place_t'(PlaceDirection) + k, Zero);
    end
  endfunction

  function automatic vector_t cross_product(place_t result, place_t x, place_t y);
    for (logic [4:0] k = 0; k < 3; k++) begin
      cross_product[k] = number(
        KindCross,
        result + k,
        x + (k + 5'd1) % 5'd3,
        y + (k + 5'd2) % 5'd3,
        x + (k + 5'd2) % 5'd3,
        y + (k + 5'd1) % 5'd3
      );
    end
  endfunction

  function automatic instruction_t dot_product(kind_e kind, place_t result, place_t x, place_t y);
    dot_product = number(kind, result, x, y, x + 5'd1, y + 5'd1, x + 5'd2, y + 5'd2);
  endfunction

  // Returns an instruction that takes the sign of x . y; with `last`, it is the last of its program.
  function automatic instruction_t sign(kind_e kind, place_t x, place_t y, logic last = 1'b0);
    sign = dot_product(kind, '0, x, y);
    sign.decide = 1'b1;
    sign.last = last;
  endfunction

  // Returns an instruction that takes the sign of (t - t') S S', with t = T / S and t' = OtherT / OtherS = T' / S'.
  function automatic instruction_t compare();
    compare = number(KindCompare, '0, T, OtherS, S, OtherT);
    compare.decide = 1'b1;
    compare.fence = 1'b1;
  endfunction

  // ---- Programs

  localparam int unsigned Length = 77;
  localparam logic [6:0] Hit = 7'd0;
  localparam logic [6:0] Limit = 7'd25;
  localparam logic [6:0] Order = 7'd45;

  // verilog_format: off
  localparam instruction_t [0:Length-1] Program = {
    // Hit: on which sides of the edges the ray passes; here A, B and C are relative to the origin
    difference(B, Triangle + 5'd3, Origin),
    difference(C, Triangle + 5'd6, Origin),
    difference(A, Triangle, Origin),
    direction(),
    cross_product(N, B, C),
    cross_product(M, C, A),
    sign(KindPlane, A, N),
    sign(KindEdge, I, N),
    cross_product(N, A, B),
    sign(KindEdge, I, M),
    sign(KindEdge, I, N, 1'b1),
    // Limit: compares t = (A . N) / (I . N) with limit / 1; N = (B - A) x (C - A), places B and C hold B - A and C - A
    difference(B, Triangle + 5'd3, Triangle),
    difference(C, Triangle + 5'd6, Triangle),
    difference(A, Triangle, Origin),
    direction(),
    number(KindPair, OtherT, place_t'(PlaceLimit), Zero),
    cross_product(N, B, C),
    number(KindPair, OtherS, place_t'(PlaceOne), Zero),
    dot_product(KindPlane, T, A, N),
    dot_product(KindEdge, S, I, N),
    compare(),
    // Order: compares t, as for Limit, with t' of the other triangle's hit
    difference(B, Triangle + 5'd3, Triangle),
    difference(C, Triangle + 5'd6, Triangle),
    difference(A, Triangle, Origin),
    direction(),
    cross_product(N, B, C),
    difference(B, Other + 5'd3, Other),
    difference(C, Other + 5'd6, Other),
    dot_product(KindPlane, T, A, N),
    cross_product(M, B, C),
    difference(A, Other, Origin),
    dot_product(KindEdge, S, I, N),
    dot_product(KindPlane, OtherT, A, M),
    dot_product(KindEdge, OtherS, I, M),
    compare()
  };
  // verilog_format: on
  // verilog_lint: waive-stop packed-dimensions-range-ordering
  // verilator lint_on UNUSEDPARAM
  // verilator lint_on LITENDIAN

endpackage
