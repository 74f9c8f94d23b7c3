// Units and digits of a request's numbers, from the exponents of its floats: as few digits as they ask for.
//
// Coordinates are in units of the smallest exponent of those that are not 0, and so are differences of them; a direction has
// a unit of its own. A hit's t = D / S, with D in units of b**3 and S of b**2 c, so t < limit compares D times b with
// S times (limit c): these two factors, `one` and `limit`, are in units of the smaller exponent. D, S and the others keep
// theirs below exact_pkg's bound: see digits_of.
//
// exponents_o, coordinate_digits_o and direction_digits_o come 2 clocks after the request, what is left 3 clocks after.
module exact_exponents #(
  parameter int unsigned ExpWidth = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned DigitWidth = 48,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth,
  localparam int unsigned CountWidth = exact_pkg::CountWidth,
  localparam int unsigned Significand = FracWidth + 1,
  localparam int unsigned Gap = exact_pkg::largest_gap(ExpWidth, Significand),
  localparam int unsigned ShiftWidth = $clog2(Gap + 1)
) (
  input  logic                               clk_i,
  input  logic [exact_pkg::Floats*Width-1:0] floats_i,
  input  logic                               with_other_i,
  output logic [ExpWidth-1:0]                coordinate_exponent_o,
  output logic [ExpWidth-1:0]                direction_exponent_o,
  output logic [CountWidth-1:0]              coordinate_digits_o,
  output logic [CountWidth-1:0]              direction_digits_o,
  output logic [ShiftWidth-1:0]              one_shift_o,
  output logic [ShiftWidth-1:0]              limit_shift_o,
  output logic [CountWidth-1:0]              pair_digits_o
);

  localparam int unsigned Least = exact_pkg::digits_of(0, Significand, DigitWidth);
  localparam int unsigned PairDigits = exact_pkg::digits_of(Gap, Significand, DigitWidth);
  // The exponent of a float whose last bit is 1.
  localparam int unsigned Unit = (1 << (ExpWidth - 1)) - 1 + FracWidth;
  localparam int unsigned Vectors = exact_pkg::PlaceLimit / 3;

  // Of numbers of `bits` bits, shifted by up to `spread`: exact_pkg::digits_of, for what is not known before.
  function automatic logic [CountWidth-1:0] count(logic [ShiftWidth-1:0] spread, int unsigned bits);
    count = CountWidth'(Least);
    for (int unsigned k = Least; k < PairDigits; k++) begin
      if (32'(spread) + bits + 3 > DigitWidth * k) count = CountWidth'(k + 1);
    end
  endfunction

  // ---- The least and the largest exponent of each vector; of a zero, none

  logic [ExpWidth-1:0] lows_d[Vectors], highs_d[Vectors], lows_q[Vectors], highs_q[Vectors];

  always_comb begin
    for (int unsigned v = 0; v < Vectors; v++) begin
      lows_d[v]  = '1;
      highs_d[v] = '0;
      for (int unsigned k = 0; k < 3; k++) begin
        if (floats_i[Width*(3*v+k)+:Width-1] != '0) begin
          if (exponent(floats_i[Width*(3*v+k)+FracWidth+:ExpWidth]) < lows_d[v]) begin
            lows_d[v] = exponent(floats_i[Width*(3*v+k)+FracWidth+:ExpWidth]);
          end
          if (exponent(floats_i[Width*(3*v+k)+FracWidth+:ExpWidth]) > highs_d[v]) begin
            highs_d[v] = exponent(floats_i[Width*(3*v+k)+FracWidth+:ExpWidth]);
          end
        end
      end
    end
  end

  function automatic logic [ExpWidth-1:0] exponent(logic [ExpWidth-1:0] field);
    exponent = (field == '0) ? ExpWidth'(1) : field;
  endfunction

  always_ff @(posedge clk_i) begin
    for (int unsigned v = 0; v < Vectors; v++) begin
      lows_q[v]  <= lows_d[v];
      highs_q[v] <= highs_d[v];
    end
  end

  // ---- Of all coordinates, and of the direction

  localparam int unsigned Direction = exact_pkg::PlaceDirection / 3;
  localparam int unsigned Other = exact_pkg::PlaceOther / 3;

  logic [ExpWidth-1:0] low, high;

  always_comb begin
    low  = '1;
    high = '0;
    for (int unsigned v = 0; v < Vectors; v++) begin
      if (v != Direction && (v < Other || with_other_i)) begin
        if (lows_q[v] < low) low = lows_q[v];
        if (highs_q[v] > high) high = highs_q[v];
      end
    end
    // Zeros alone: any unit will do.
    if (high == '0) {low, high} = {2{ExpWidth'(1)}};
  end

  always_ff @(posedge clk_i) begin
    coordinate_exponent_o <= low;
    direction_exponent_o  <= lows_q[Direction];
    coordinate_digits_o   <= count(ShiftWidth'(high) - ShiftWidth'(low), Significand);
    direction_digits_o    <= count(
        ShiftWidth'(highs_q[Direction]) - ShiftWidth'(lows_q[Direction]), Significand);
  end

  // ---- Of a limit: b against c times the limit's unit

  logic [ShiftWidth:0] one_exponent, limit_exponent;
  logic [ShiftWidth-1:0] gap;
  logic less;

  assign one_exponent = (ShiftWidth + 1)'(coordinate_exponent_o) + (ShiftWidth + 1)'(Unit);
  assign limit_exponent = (ShiftWidth + 1)'(direction_exponent_o) + (ShiftWidth + 1)'(
      exponent(floats_i[Width*exact_pkg::PlaceLimit+FracWidth+:ExpWidth]));
  assign less = one_exponent < limit_exponent;
  assign gap = less ? ShiftWidth'(limit_exponent - one_exponent)
                    : ShiftWidth'(one_exponent - limit_exponent);

  always_ff @(posedge clk_i) begin
    one_shift_o   <= less ? '0 : gap;
    limit_shift_o <= less ? gap : '0;
    pair_digits_o <= less ? count(gap, Significand) : count(gap, 1);
  end

endmodule
