// Floating-point compare: equal, less, unordered.
//
// NaN is unordered with everything, itself included: equal_o = less_o = 0. -0 equals +0. The only flag is invalid. With
// signaling_i = 1 any NaN raises it, as < and <= require; with 0 only a signalling NaN does, as == requires. (a <= b is
// less_o | equal_o; for a > b, exchange the operands and use less_o.)
//
// Combinational; takes every bit pattern. Source: IEEE 754-2019, clause 5.11.
module fp_compare #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23
) (
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  logic                        signaling_i,
  output logic                        equal_o,
  output logic                        less_o,
  output logic                        unordered_o,
  output fp_pkg::flags_t              flags_o
);

  localparam int unsigned MagWidth = ExpWidth + FracWidth;  // width of a word without its sign
  localparam logic [MagWidth-1:0] Infinity = {{ExpWidth{1'b1}}, {FracWidth{1'b0}}};

  logic a_sign, b_sign, a_nan, b_nan, any_signaling, both_zero;
  logic [MagWidth-1:0] a_mag, b_mag;

  // ---- Classes

  assign {a_sign, a_mag} = a_i;
  assign {b_sign, b_mag} = b_i;
  assign a_nan = a_mag > Infinity;
  assign b_nan = b_mag > Infinity;
  assign any_signaling = (a_nan & ~a_mag[FracWidth-1]) | (b_nan & ~b_mag[FracWidth-1]);
  assign both_zero = (a_mag | b_mag) == '0;

  // ---- Magnitudes: as integers, packed words have the order of their values

  logic mag_less, mag_equal;

  assign mag_less = a_mag < b_mag;
  assign mag_equal = a_mag == b_mag;

  // ---- Order

  assign unordered_o = a_nan | b_nan;
  assign equal_o = ~unordered_o & ((mag_equal & (a_sign == b_sign)) | both_zero);

  always_comb begin
    if (unordered_o || both_zero) less_o = 1'b0;
    else if (a_sign != b_sign) less_o = a_sign;
    else less_o = a_sign ? ~(mag_less | mag_equal) : mag_less;
  end

  assign flags_o = {any_signaling | (signaling_i & unordered_o), 4'b0000};

endmodule
