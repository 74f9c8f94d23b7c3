// Claims for any constant inputs of exact_exponents: The unit of the coordinates has the lowest exponent of all nonzero
// coordinates; therefore they are integer multiples of it. The same holds for the direction's unit and components. In
// these units, the numbers and differences of two of them fit in the given digits, but not in one digit less. `one` and
// `limit` fit, too. Their shifts make D * one < S * limit equivalent to t < limit, with t = D / S of a hit, and D and S
// in the units that the header of exact_exponents states.
module exact_exponents_fit #(
  parameter int unsigned ExpWidth = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned DigitWidth = 48,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth,
  localparam int unsigned Words = exact_pkg::Floats * Width,
  localparam int unsigned Gap = exact_pkg::largest_gap(ExpWidth, FracWidth + 1),
  localparam int unsigned ShiftWidth = $clog2(Gap + 1)
) (
  input logic clk,
  input logic [Words-1:0] any_floats,
  input logic any_with_other
);

  localparam int unsigned Significand = FracWidth + 1;
  localparam int unsigned Bias = (1 << (ExpWidth - 1)) - 1;

  logic [Words-1:0] floats;
  logic with_other;
  logic [ExpWidth-1:0] coordinate_exponent, direction_exponent;
  logic [5:0] coordinate_digits, direction_digits, pair_digits;
  logic [ShiftWidth-1:0] one_shift, limit_shift;

  exact_exponents #(
    .ExpWidth  (ExpWidth),
    .FracWidth (FracWidth),
    .DigitWidth(DigitWidth)
  ) dut (
    .clk_i                (clk),
    .floats_i             (floats),
    .with_other_i         (with_other),
    .coordinate_exponent_o(coordinate_exponent),
    .direction_exponent_o (direction_exponent),
    .coordinate_digits_o  (coordinate_digits),
    .direction_digits_o   (direction_digits),
    .one_shift_o          (one_shift),
    .limit_shift_o        (limit_shift),
    .pair_digits_o        (pair_digits)
  );

  // Assumptions: the words are constant and finite, the direction is not 0, the limit is positive
  logic [2:0] clocks;
  initial clocks = '0;
  always_ff @(posedge clk) begin
    if (clocks < 3'd6) clocks <= clocks + 1'b1;
    if (clocks == '0) {with_other, floats} <= {any_with_other, any_floats};
  end

  logic [exact_pkg::Floats-1:0] nonzero;
  logic [ExpWidth-1:0] exponents[exact_pkg::Floats];
  for (genvar k = 0; k < exact_pkg::Floats; k++) begin : gen_float
    assign nonzero[k] = floats[Width*k+:Width-1] != '0;
    assign exponents[k] = (floats[Width*k+FracWidth+:ExpWidth] == '0) ? ExpWidth'(1) : floats[Width*k+FracWidth+:ExpWidth];
    always_comb assume (clocks == '0 || floats[Width*k+FracWidth+:ExpWidth] != '1);
  end
  always_comb begin
    assume (clocks == '0 || (nonzero[5:3] != '0 && nonzero[24] && !floats[Words-1]));
  end

  // ---- Bits of the numbers, and whether each number fits

  logic [15:0] coordinate_room, direction_room, pair_room;
  assign coordinate_room = DigitWidth * 16'(coordinate_digits);
  assign direction_room  = DigitWidth * 16'(direction_digits);
  assign pair_room       = DigitWidth * 16'(pair_digits);

  logic [exact_pkg::Floats-1:0] counts, lowest, widest, fits;
  for (genvar k = 0; k < 24; k++) begin : gen_claim
    localparam bit Direction = k >= 3 && k < 6;
    logic [15:0] spread, room;
    assign counts[k] = nonzero[k] && (k < 15 || with_other);
    assign spread    = 16'(exponents[k]) - 16'(Direction ? direction_exponent : coordinate_exponent);
    assign room      = Direction ? direction_room : coordinate_room;
    assign lowest[k] = counts[k] && spread == '0;
    assign fits[k]   = !counts[k] || (!spread[15] && spread + 16'(Significand + 3) <= room);
    assign widest[k] = counts[k] && spread + 16'(Significand + 3) > room - 16'(DigitWidth);
  end
  assign {counts[24], lowest[24], widest[24], fits[24]} = '0;

  localparam logic [24:0] Coordinates = 25'h0ffffc7;
  logic signed [15:0] one_unit, limit_unit;
  assign one_unit   = 16'(coordinate_exponent);
  assign limit_unit = 16'(direction_exponent) + 16'(exponents[24]) - 16'(Bias + FracWidth);

  always_comb begin
    if (clocks == 3'd5) begin
      assert (&fits[23:0]);
      assert ((lowest & Coordinates) != '0 || (counts & Coordinates) == '0);
      assert ((widest & Coordinates) != '0 || 16'(Significand + 3) > coordinate_room - 16'(DigitWidth));
      assert (lowest[5:3] != '0);
      assert (widest[5:3] != '0 || 16'(Significand + 3) > direction_room - 16'(DigitWidth));
      assert (one_shift == '0 || limit_shift == '0);
      assert (one_unit - $signed(16'(one_shift)) == limit_unit - $signed(16'(limit_shift)));
      assert (16'(one_shift) + 16'd4 <= pair_room && 16'(limit_shift) + 16'(Significand + 3) <= pair_room);
    end
    cover (clocks == 3'd5 && coordinate_digits > 6'd1);
  end

endmodule
