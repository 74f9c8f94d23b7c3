// What set_up_unit and those who use its records share: format, latency, and how far off its planes are.
package set_up_pkg;

  // verilator lint_off UNUSEDPARAM
  // No top uses everything.

  localparam int unsigned ExpWidth = 8;  // binary32, for which the bounds are proven
  localparam int unsigned FracWidth = 23;
  localparam int unsigned Width = 1 + ExpWidth + FracWidth;

  // From the clock edge that takes a triangle to that after which its record is there: two differences,
  // a product between them, and a dot product.
  localparam int unsigned Latency = 16;

  // ---- How far off N and d are: see set_up_unit

  localparam int unsigned PlaneErrorWidth = 4;

  // The largest that gives a plane that is good enough, alone or with the unit's t_error added.
  localparam int unsigned MostPlaneError = 14;

  // Between a hit's t and the exact one lie fewer than 2**t_error_exponent numbers, where
  // is_good_hit: t_error is hit_test_pipeline's, the others are set_up_unit's.
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

  // verilator lint_on UNUSEDPARAM

endpackage
