// Shared by the parts of the exact unit: requests, answers, numbers, instructions, steps.
//
// A number is the sum of d_k 2**(DigitWidth k), k = 0, 1, ..., in units of a power of two that is common to all numbers
// of its kind. Its digits are balanced, -2**(DigitWidth-1) <= d_k < 2**(DigitWidth-1), in two's complement, so the
// highest non-zero digit has the number's sign. n digits hold any number of magnitude below 2**(DigitWidth n - 2).
package exact_pkg;

  // verilator lint_off UNUSEDPARAM
  // No top module uses everything.

  // ---- A request

  // Places (word numbers) of a request's floats: a vector is x, y, z from its place on, a triangle is A, B, C.
  localparam int unsigned PlaceWidth = 5;
  localparam int unsigned PlaceOrigin = 0;
  localparam int unsigned PlaceDirection = 3;
  localparam int unsigned PlaceTriangle = 6;
  localparam int unsigned PlaceOther = 15;
  localparam int unsigned PlaceLimit = 24;
  localparam int unsigned Floats = 25;
  localparam int unsigned PlaceOne = 25;  // the constant 1, in the units of a limit

  // What a hit is compared with.
  typedef enum logic [1:0] {
    AgainstNothing = 2'd0,
    AgainstLimit   = 2'd1,
    AgainstOther   = 2'd2  // another triangle's hit
  } against_e;

  // The sign of a number.
  typedef struct packed {
    logic negative;
    logic nonzero;
  } sign_t;

  // ---- Numbers in memory
  //
  // Numbers 0 to 2: the direction; 3 to 11: corners or edges; 12 to 17: two normals, of twice as many digits; 18 to 21:
  // dividends and divisors of two hits' t, of three times as many digits.

  localparam int unsigned NumberWidth = 5;
  localparam int unsigned Normal = 12;
  localparam int unsigned SecondNormal = 15;
  localparam int unsigned Distance = 18;
  localparam int unsigned OtherDistance = 20;
  localparam int unsigned Numbers = 22;

  localparam int unsigned CountWidth = 6;  // width of a count of digits

  // Returns the number of words of the memory of digits, if a difference has up to `digits` digits.
  function automatic int unsigned memory_depth(int unsigned digits);
    memory_depth = (12 + 6 * 2 + 4 * 3) * digits;
  endfunction

  // Returns the address of a number's digit 0.
  function automatic int unsigned number_base(int unsigned number, int unsigned digits);
    number_base = (number < Normal) ? number * digits
                : (number < Distance) ? (Normal + 2 * (number - Normal)) * digits
                : (24 + 3 * (number - Distance)) * digits;
  endfunction

  // ---- Number of digits that a range of exponents needs
  //
  // With e its exponent field (1 for subnormals), a float is a whole number of significand_width bits in units of
  // 2**(e-Bias-FracWidth). Let the smallest exponent give the unit, and the largest be `spread` above it. A difference
  // of two such numbers is below 2**(spread + significand_width + 1); digits_of returns enough digits for it.

  function automatic int unsigned digits_of(int unsigned spread, int unsigned significand_width,
                                            int unsigned width);
    digits_of = (spread + significand_width + 3 + width - 1) / width;
  endfunction

  // Return the maximum number of digits of a difference, and the maximum shift of `limit` or `one` (exact_exponents).
  function automatic int unsigned difference_digits(
    int unsigned exp_width, int unsigned significand_width, int unsigned width);
    difference_digits = digits_of((1 << exp_width) - 3, significand_width, width);
  endfunction
  function automatic int unsigned largest_gap(int unsigned exp_width,
                                              int unsigned significand_width);
    largest_gap = (1 << exp_width) - 2 + (1 << (exp_width - 1)) - 1 + significand_width;
  endfunction

  // Returns the width of the accumulator for columns of at most `products` products: see exact_accumulator.
  function automatic int unsigned sum_width(int unsigned width, int unsigned products);
    sum_width = 2 * width + $clog2(products) + 1;
  endfunction

  // ---- Instructions, see exact_program_pkg

  typedef enum logic [2:0] {
    KindCoordinate = 3'd0,  // one coordinate minus another
    KindRay        = 3'd1,  // a direction's component
    KindPair       = 3'd2,  // the limit, or the constant 1
    KindCross      = 3'd3,  // x0 y0 - x1 y1: a component of a normal
    KindPlane      = 3'd4,  // x0 y0 + x1 y1 + x2 y2: a corner times a normal
    KindEdge       = 3'd5,  // as KindPlane: the direction times a normal
    KindCompare    = 3'd6   // x0 y0 - x1 y1: compares two fractions
  } kind_e;

  typedef struct packed {
    kind_e kind;
    logic decide;  // 1: takes the sign of the sum; 0: makes the number `result`
    logic fence;  // starts only when all earlier results are written
    logic last;  // the last of the program Hit
    logic [NumberWidth-1:0] result;
    logic [NumberWidth-1:0] y2;
    logic [NumberWidth-1:0] x2;
    logic [NumberWidth-1:0] y1;
    logic [NumberWidth-1:0] x1;
    logic [NumberWidth-1:0] y0;
    logic [NumberWidth-1:0] x0;
  } instruction_t;

  // ---- A step: adds a product of two digits, or a digit of a difference of floats, to the accumulator

  typedef struct packed {
    kind_e kind;
    logic down;  // columns go downwards, for a sign
    logic last;  // as in instruction_t
    logic second;  // the instruction's normal is SecondNormal
    logic [NumberWidth-1:0] result;
    logic negate;
    logic empty;  // nothing is added
    logic first;  // first step of the instruction
    logic opens;  // first step of a column
    logic closes;  // last step of a column
    logic ends;  // the column is the instruction's last
    logic low;  // the column is column 0
  } step_t;

  // verilator lint_on UNUSEDPARAM

endpackage
