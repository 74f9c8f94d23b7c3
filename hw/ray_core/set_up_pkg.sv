// Shared by triangle_test and users of its verdicts: number format, error bounds of planes and of hits.
package set_up_pkg;

  // verilator lint_off UNUSEDPARAM
  // No top module uses everything.

  localparam int unsigned ExpWidth = 8;  // binary32, for which the bounds are proven
  localparam int unsigned FracWidth = 23;
  localparam int unsigned Width = 1 + ExpWidth + FracWidth;

  // ---- Errors of N and d: see triangle_test

  localparam int unsigned PlaneErrorWidth = 4;

  // Largest normal_error and distance_error of a usable plane, and largest t_error + normal_error of a usable hit.
  localparam int unsigned MostPlaneError = 14;

  // For a hit with is_good_hit, fewer than 2**t_error_exponent binary32 numbers lie between its t and the exact t.
  // t_error is hit_decision's; the other errors are plane_of's.
  localparam int unsigned TErrorUnit = 8;
  localparam int unsigned TErrorExponentWidth = 5;

  function automatic logic is_good_hit(logic [TErrorExponentWidth-1:0] t_error,
                                       logic [PlaneErrorWidth-1:0] normal_error);
    is_good_hit = 32'(t_error) + 32'(normal_error) <= MostPlaneError;
  endfunction

  function automatic logic [TErrorExponentWidth-1:0] t_error_exponent(
    logic [TErrorExponentWidth-1:0] t_error, logic [PlaneErrorWidth-1:0] normal_error,
    logic [PlaneErrorWidth-1:0] distance_error);
    logic [TErrorExponentWidth-1:0] plane, distance;
    plane    = t_error + TErrorExponentWidth'(normal_error);
    distance = TErrorExponentWidth'(distance_error);
    t_error_exponent = TErrorExponentWidth'(TErrorUnit) + ((plane > distance) ? plane : distance);
  endfunction

  // ---- Bounds; the header of triangle_test derives them

  localparam int unsigned LeastField = 27;  // smallest exponent field that is not tiny: 2**-100
  localparam int unsigned BoundShift = 20;  // 16 u = 2**-20, with u = 2**-24
  localparam logic [Width-1:0] NaN = {1'b0, {ExpWidth{1'b1}}, 1'b1, {(FracWidth - 1) {1'b0}}};

  // Returns an edge's bound: 16 u T', or infinity if T' (`sum`), the sum of its terms, is tiny or infinite.
  function automatic logic [Width-1:0] bound(logic [Width-1:0] sum);
    logic [ExpWidth-1:0] field;
    field = sum[FracWidth+:ExpWidth];
    bound = ((field >= ExpWidth'(LeastField)) & ~(&field))
        ? {sum[Width-1], field - ExpWidth'(BoundShift), sum[FracWidth-1:0]}
        : {1'b0, {ExpWidth{1'b1}}, {FracWidth{1'b0}}};
  endfunction

  // Returns the largest exponent field of a vector's components.
  // verilator lint_off UNUSEDSIGNAL
  function automatic logic [ExpWidth-1:0] largest(logic [3*Width-1:0] vector);
    // verilator lint_on UNUSEDSIGNAL
    largest = vector[FracWidth+:ExpWidth];
    for (int unsigned k = 1; k < 3; k++) begin
      if (vector[Width*k+FracWidth+:ExpWidth] > largest) begin
        largest = vector[Width*k+FracWidth+:ExpWidth];
      end
    end
  endfunction

  typedef struct packed {
    logic                       good;  // the errors are small enough
    logic [PlaneErrorWidth-1:0] normal_error;
    logic [PlaneErrorWidth-1:0] distance_error;
  } plane_t;

  // Returns a plane's errors from exponent fields: that of d, and the largest of A (`vertex`), of N, of N's terms.
  function automatic plane_t plane_of(logic [ExpWidth-1:0] vertex, logic [ExpWidth-1:0] normal,
                                      logic [ExpWidth-1:0] terms, logic [ExpWidth-1:0] d);
    localparam logic [ExpWidth+1:0] Bias = (ExpWidth + 2)'(2 ** (ExpWidth - 1) - 1);
    logic [ExpWidth+1:0] normal_error, distance_error;  // two's complement
    logic good;
    normal_error   = (ExpWidth + 2)'(terms) - (ExpWidth + 2)'(normal);
    distance_error = (ExpWidth + 2)'(vertex) + (ExpWidth + 2)'(terms) - (ExpWidth + 2)'(d) - Bias;
    good = (terms >= ExpWidth'(LeastField)) & ~(&terms) & ~(&vertex)
        & (d >= ExpWidth'(LeastField)) & ~(&d) & (normal_error <= (ExpWidth + 2)'(MostPlaneError))
        & (distance_error[ExpWidth+1] | (distance_error <= (ExpWidth + 2)'(MostPlaneError)));
    plane_of = {good, PlaneErrorWidth'(normal_error),
                PlaneErrorWidth'(distance_error[ExpWidth+1] ? '0 : distance_error)};
  endfunction

  // verilator lint_on UNUSEDPARAM

endpackage
