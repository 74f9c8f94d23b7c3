// Rounder: an exact value in, an IEEE number and its flags out.
//
// The value is (-1)**sign_i * significand_i / 2**(FracWidth+3) * 2**(exponent_i + 1 - bias), with
//   significand_i  two integer bits, FracWidth fraction bits, guard, round, sticky (the OR of all bits further down).
//                  In [1, 4): a product or a quotient need not be normalised.
//   exponent_i     the biased exponent *less one*, signed. The integer bits 00, 01, 1x add 0, 1, 2 to it. If exponent_i
//                  is below 0, the significand is first shifted right by -exponent_i.
//
// SubnormalShift = 0 omits the right shift, for a core whose significand is in place already: exponent_i is then never
// negative, and if it is 0, significand_i may be anything in [0, 4), zero included. (Subnormal sums are exact and need
// no shift.)
//
// Priority: special_i's nan (the canonical NaN), infinity, zero, then overflow, then the rounded value. Any of the
// first three suppresses overflow, underflow, inexact; invalid and divide_by_zero go straight to the flags. sign_i is
// the sign of every result but NaN.
//
// rounding_mode_i: fp_pkg::rounding_mode_e; the reserved values 5, 6 and 7 round towards zero.
// Tininess is detected after rounding with tininess_after_i = 1 (the value rounded with unbounded exponent is below
// 2**(1-bias)), else before rounding. Underflow is raised if the result is tiny and inexact.
//
// Combinational. Error: at most 0.5 ulp when rounding to nearest, below 1 ulp in other modes.
// Source: IEEE 754-2019, clauses 4.3 and 7.4 to 7.6.
module fp_round #(
  parameter int unsigned ExpWidth       = 8,
  parameter int unsigned FracWidth      = 23,
  parameter bit          SubnormalShift = 1'b1
) (
  input  logic                          sign_i,
  input  logic signed [ExpWidth+1:0]    exponent_i,
  input  logic        [FracWidth+4:0]   significand_i,
  input  fp_pkg::special_t              special_i,
  input  logic [2:0]                    rounding_mode_i,
  input  logic                          tininess_after_i,
  output logic [ExpWidth+FracWidth:0]   result_o,
  output fp_pkg::flags_t                flags_o
);

  if (ExpWidth < 3 || FracWidth < 2 || FracWidth > 2 ** (ExpWidth - 1)) begin : gen_check
    $error("fp_round: expected an ExpWidth of 3 or more and a FracWidth of 2 to 2**(ExpWidth-1)");
  end

  localparam int unsigned SigWidth = FracWidth + 5;  // 2 integer, fraction, guard, round, sticky
  localparam int unsigned FieldWidth = ExpWidth + 1;  // exponent field, one bit more for overflow
  localparam int unsigned WordWidth = ExpWidth + FracWidth;
  localparam logic [FieldWidth-1:0] InfField = {1'b0, {ExpWidth{1'b1}}};

  // ---- Rounding mode: to nearest, or away from zero for this sign (neither: towards zero)

  logic nearest_even, nearest, away;
  assign nearest_even = rounding_mode_i == fp_pkg::RoundNearestEven;
  assign nearest = nearest_even || rounding_mode_i == fp_pkg::RoundNearestMaxMagnitude;
  assign away = rounding_mode_i == (sign_i ? fp_pkg::RoundDown : fp_pkg::RoundUp);

  // ---- Subnormal results: shift right until the exponent is the smallest one

  logic [SigWidth-1:0] placed;
  logic [FieldWidth-1:0] base;  // exponent_i, or 0 if exponent_i is negative
  logic negative;

  assign negative = exponent_i[ExpWidth+1];
  assign base = exponent_i[FieldWidth-1:0] & {FieldWidth{~negative}};

  if (SubnormalShift) begin : gen_shift
    // Shift by -exponent_i = ~exponent_i + 1: ~exponent_i places, and one more by leaving out the significand's bit 0
    logic [SigWidth-2:0] shifted;
    logic lost;

    sticky_right_shift #(
      .Width(SigWidth - 1),
      .AmountWidth(ExpWidth + 1)
    ) u_shift (
      .a_i(significand_i[SigWidth-1:1]),
      .amount_i(~exponent_i[ExpWidth:0]),
      .shifted_o(shifted),
      .lost_o(lost)
    );
    assign placed = negative ? {1'b0, shifted[SigWidth-2:1], shifted[0] | lost | significand_i[0]}
                             : significand_i;
  end else begin : gen_in_place
    assign placed = significand_i;
  end

  // ---- Normalise: the integer bits select one of three exponents

  logic [SigWidth-2:0] normal;  // with one integer bit; all bits below the guard bit are sticky
  logic [FracWidth-1:0] fraction;
  logic guard, sticky;

  assign normal = placed[SigWidth-1] ? {placed[SigWidth-1:2], |placed[1:0]} : placed[SigWidth-2:0];
  assign fraction = normal[SigWidth-3-:FracWidth];
  assign guard = normal[2];
  assign sticky = |normal[1:0];

  // ---- Round: a carry out of the fraction increments the exponent field

  logic inexact, overflow;
  logic [WordWidth-1:0] rounded;  // valid unless there is overflow

  assign inexact = guard | sticky;

  logic [FieldWidth-1:0] base_plus_1, base_plus_2, field;
  logic increment, unused_integer_bit;

  assign increment = (nearest & guard & (sticky | fraction[0] | ~nearest_even))
                   | (away & (guard | sticky));
  assign unused_integer_bit = normal[SigWidth-2];
  assign base_plus_1 = base + FieldWidth'(1);
  assign base_plus_2 = base + FieldWidth'(2);
  assign field = placed[SigWidth-1] ? base_plus_2 : placed[SigWidth-2] ? base_plus_1 : base;

  assign rounded = {field[ExpWidth-1:0], fraction} + WordWidth'(increment);
  // Computed in parallel with the increment
  assign overflow = (field >= InfField) | ((field == InfField - 1'b1) & (&fraction) & increment);

  // ---- Tininess: before rounding, a value is tiny if its integer bits are 00. After rounding, it is not tiny if it
  // rounds up to 1 with one bit more (unbounded exponent): if all bits down to the guard bit are 1, and are incremented

  logic tiny, increment_below;
  assign increment_below = (nearest & placed[1]) | (away & |placed[1:0]);
  assign tiny = (placed[SigWidth-1-:2] == 2'b00)
              & ~(tininess_after_i & (&fraction) & guard & increment_below);

  logic special, to_infinity;
  assign special = special_i.nan | special_i.infinity | special_i.zero;
  assign to_infinity = nearest | away;

  // ---- Result

  localparam logic [WordWidth-1:0] NotANumber = {{(ExpWidth + 1) {1'b1}}, {(FracWidth - 1) {1'b0}}};
  localparam logic [WordWidth-1:0] Infinity = {{ExpWidth{1'b1}}, {FracWidth{1'b0}}};
  localparam logic [WordWidth-1:0] Largest = {{(ExpWidth - 1) {1'b1}}, 1'b0, {FracWidth{1'b1}}};
  logic [WordWidth-1:0] magnitude;

  always_comb begin
    magnitude = rounded;
    if (special | overflow) begin
      if (special_i.nan) magnitude = NotANumber;
      else if (special_i.infinity) magnitude = Infinity;
      else if (special_i.zero) magnitude = '0;
      else magnitude = to_infinity ? Infinity : Largest;
    end
  end

  assign result_o = {sign_i & ~special_i.nan, magnitude};
  assign flags_o = {
    special_i.invalid,
    special_i.divide_by_zero,
    overflow & ~special,
    tiny & inexact & ~special,
    (inexact | overflow) & ~special
  };

endmodule
