// Units and digits of a request's numbers: as few digits as the exponents of its floats need.
//
// The unit b of coordinates and of their differences comes from the smallest exponent of all non-zero coordinates, the
// unit c of the direction from the smallest exponent of its non-zero components. A hit is at t = D / S (exact_unit),
// with D in units of b**3 and S in units of b**2 c. So t is below a limit if D * b is below S * (limit * c). The
// factors b (`one`) and limit * c (`limit`) are stored as numbers, too; their common unit is the lower of their last
// bits. exact_pkg's digits_of gives enough digits for all numbers.
//
// Latency: 2 to 4 clocks (2 for the exponents, 3 for their digits, 4 for the rest).
module exact_exponents
  import exact_pkg::*;
#(
  parameter int unsigned ExpWidth = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned DigitWidth = 48,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth,
  localparam int unsigned Significand = FracWidth + 1,
  localparam int unsigned Gap = largest_gap(ExpWidth, Significand),
  localparam int unsigned ShiftWidth = $clog2(Gap + 1)
) (
  input  logic                    clk_i,
  input  logic [Floats*Width-1:0] floats_i,
  input  logic                    with_other_i,
  output logic [ExpWidth-1:0]     coordinate_exponent_o,
  output logic [ExpWidth-1:0]     direction_exponent_o,
  output logic [CountWidth-1:0]   coordinate_digits_o,
  output logic [CountWidth-1:0]   direction_digits_o,
  output logic [ShiftWidth-1:0]   one_shift_o,
  output logic [ShiftWidth-1:0]   limit_shift_o,
  output logic [CountWidth-1:0]   pair_digits_o
);

  localparam int unsigned Least = digits_of(0, Significand, DigitWidth);
  localparam int unsigned PairDigits = digits_of(Gap, Significand, DigitWidth);
  // Exponent field of a float whose last bit has the value 1.
  localparam int unsigned Unit = (1 << (ExpWidth - 1)) - 1 + FracWidth;
  localparam int unsigned Vectors = PlaceLimit / 3;

  // Returns digits_of(spread, bits, DigitWidth), for a `spread` that is a signal.
  function automatic logic [CountWidth-1:0] count(logic [ShiftWidth-1:0] spread, int unsigned bits);
    count = CountWidth'(Least);
    for (int unsigned k = Least; k < PairDigits; k++) begin
      if (32'(spread) + bits + 3 > DigitWidth * k) count = CountWidth'(k + 1);
    end
  endfunction

  // ---- The least and the largest exponent of each vector's non-zero components

  logic [ExpWidth-1:0] lows_d[Vectors], highs_d[Vectors], lows_q[Vectors], highs_q[Vectors];

  always_comb begin : extremes
    logic [ExpWidth-1:0] field;
    for (int unsigned v = 0; v < Vectors; v++) begin
      lows_d[v]  = '1;
      highs_d[v] = '0;
      for (int unsigned k = 0; k < 3; k++) begin
        field = effective(floats_i[Width*(3*v+k)+FracWidth+:ExpWidth]);
        if (floats_i[Width*(3*v+k)+:Width-1] != '0) begin
          if (field < lows_d[v]) lows_d[v] = field;
          if (field > highs_d[v]) highs_d[v] = field;
        end
      end
    end
  end

  function automatic logic [ExpWidth-1:0] effective(logic [ExpWidth-1:0] field);
    effective = (field == '0) ? ExpWidth'(1) : field;
  endfunction

  always_ff @(posedge clk_i) begin
    for (int unsigned v = 0; v < Vectors; v++) begin
      lows_q[v]  <= lows_d[v];
      highs_q[v] <= highs_d[v];
    end
  end

  // ---- Exponents and digits of all coordinates, and of the direction

  localparam int unsigned Direction = PlaceDirection / 3;
  localparam int unsigned Other = PlaceOther / 3;

  logic [ExpWidth-1:0] lows[2*Vectors], highs[2*Vectors];  // trees: n's children are 2 n, 2 n + 1
  logic [ExpWidth-1:0] coordinate_high_q, direction_high_q;

  always_comb begin
    {lows[0], highs[0]} = '0;
    for (int unsigned v = 0; v < Vectors; v++) begin
      lows[Vectors+v]  = '1;
      highs[Vectors+v] = '0;
      if (v != Direction && (v < Other || with_other_i)) begin
        lows[Vectors+v]  = lows_q[v];
        highs[Vectors+v] = highs_q[v];
      end
    end
    for (int unsigned n = Vectors - 1; n > 0; n--) begin
      lows[n]  = (lows[2*n] < lows[2*n+1]) ? lows[2*n] : lows[2*n+1];
      highs[n] = (highs[2*n] > highs[2*n+1]) ? highs[2*n] : highs[2*n+1];
    end
  end

  always_ff @(posedge clk_i) begin
    // If all coordinates are zero, any unit will do.
    coordinate_exponent_o <= (highs[1] == '0) ? ExpWidth'(1) : lows[1];
    coordinate_high_q     <= (highs[1] == '0) ? ExpWidth'(1) : highs[1];
    direction_exponent_o  <= lows_q[Direction];
    direction_high_q      <= highs_q[Direction];
    coordinate_digits_o   <= count(
        ShiftWidth'(coordinate_high_q) - ShiftWidth'(coordinate_exponent_o), Significand);
    direction_digits_o    <= count(
        ShiftWidth'(direction_high_q) - ShiftWidth'(direction_exponent_o), Significand);
  end

  // ---- Exponents and digits of `one` (b) and `limit` (the limit times c)

  logic [ShiftWidth:0] one_exponent, limit_exponent;
  logic [ShiftWidth-1:0] gap_q;
  logic less, less_q;

  assign one_exponent = (ShiftWidth + 1)'(coordinate_exponent_o) + (ShiftWidth + 1)'(Unit);
  assign limit_exponent = (ShiftWidth + 1)'(direction_exponent_o) + (ShiftWidth + 1)'(
      effective(floats_i[Width*PlaceLimit+FracWidth+:ExpWidth]));
  assign less = one_exponent < limit_exponent;

  always_ff @(posedge clk_i) begin
    less_q <= less;
    gap_q  <= less ? ShiftWidth'(limit_exponent - one_exponent)
                   : ShiftWidth'(one_exponent - limit_exponent);
    one_shift_o   <= less_q ? '0 : gap_q;
    limit_shift_o <= less_q ? gap_q : '0;
    pair_digits_o <= less_q ? count(gap_q, Significand) : count(gap_q, 1);
  end

endmodule
