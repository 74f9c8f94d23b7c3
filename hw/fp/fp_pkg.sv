// Shared by all floating-point cores: rounding modes and exception flags.
//
// Every core takes a format as two parameters, ExpWidth and FracWidth (binary32: 8 and 23, binary16: 5 and 10,
// bfloat16: 8 and 7), packed as in IEEE 754: sign, biased exponent, fraction. Operands and results may be subnormal;
// every NaN result is the one quiet NaN with sign 0 and only the top fraction bit set (0x7fc00000 in binary32). Formats
// need 3 <= ExpWidth and 2 <= FracWidth <= 2**(ExpWidth-1): the exponent of a subnormal result then fits into ExpWidth
// + 2 signed bits. The divider needs FracWidth <= 53. The multiplier needs FracWidth <= 75, the widest sum for which
// arith_pkg has carry-select groups.
//
// hw/arith's adder (of the kind that parameter Arith chooses) adds and subtracts significands and exponents; its
// multiplier and srt_divider multiply and divide significands. Comparisons, and increments by one or two, use the
// language's operators: synthesis makes structures for them that are no slower than those of hw/arith.
// Source: IEEE 754-2019, clauses 3.4 (formats), 4.3 (rounding), 7 (exceptions).
package fp_pkg;

  // RISC-V's encoding. The values 5, 6 and 7 round towards zero.
  typedef enum logic [2:0] {
    RoundNearestEven         = 3'd0,
    RoundTowardZero          = 3'd1,
    RoundDown                = 3'd2,
    RoundUp                  = 3'd3,
    RoundNearestMaxMagnitude = 3'd4
  } rounding_mode_e;

  // Class of an operand, see fp_unpack
  typedef struct packed {
    logic special;  // zero, infinity or nan
    logic zero;
    logic infinity;
    logic nan;      // quiet or signalling
    logic signaling_nan;
  } class_t;

  // A special result that replaces the rounded value, and the flags that rounding does not raise: see fp_round
  typedef struct packed {
    logic nan;
    logic infinity;
    logic zero;
    logic invalid;
    logic divide_by_zero;
  } special_t;

  // Inexact is bit 0: the order of RISC-V and TestFloat.
  typedef struct packed {
    logic invalid;
    logic divide_by_zero;
    logic overflow;
    logic underflow;
    logic inexact;
  } flags_t;

endpackage
