// Accumulator of the exact unit: sums of digit products, column by column, without rounding.
//
// Product scanning (Comba, "Exponentiation cryptosystems on the IBM PC", IBM Systems Journal 29, 1990): column k has all
// products of a digit i and a digit k - i. What Kulisch's long accumulator (Computer Arithmetic and Validity, 2013)
// holds in a memory as wide as the exponents' range, this one passes through in one register, a column at a time:
//
//   upwards    a column's sum leaves its low DigitWidth bits, a balanced digit of the result, and carries what is left
//              into the next one;
//   downwards  the sum so far, times 2**DigitWidth, and the next column's. Columns below can take away less than
//              2**SureBit of it: they have Products products at most, each 2**(2 DigitWidth - 2) at most, so below
//              Products 2**(DigitWidth - 2) (1 + 2**(1 - DigitWidth)) together. A sum beyond is sure of its sign, and one that
//              is not has room for another column: |sum| < 2**(2 DigitWidth + log2 Products).
//
// A step comes in at one clock edge; with the next, sum_o has it, and closed_o says of sum_o that it ends a column.
module exact_accumulator #(
  parameter int unsigned DigitWidth = 48,
  parameter int unsigned Products = 36,  // in a column, at most
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded
) (
  input  logic                    clk_i,
  input  logic                    opens_i,
  input  logic                    first_i,
  input  logic                    down_i,
  input  logic [2*DigitWidth-1:0] product_i,
  input  logic                    negate_i,
  input  logic [DigitWidth-1:0]   second_i,        // of a difference: negate_i is 0 then
  input  logic                    with_second_i,
  input  logic                    subtract_second_i,
  output logic                    negative_o,      // of the digit
  output logic [DigitWidth-1:0]   magnitude_o,
  output logic                    sum_negative_o,
  output logic                    sum_zero_o,
  output logic                    sure_o           // whatever the columns below
);

  localparam int unsigned SureBit = DigitWidth - 1 + $clog2(Products);
  localparam int unsigned Width = 2 * DigitWidth + $clog2(Products) + 1;

  // ---- Sum of what stays, a product and another term

  logic [Width-1:0] sum_q, stays, product, second, partial, carries, sum_d;
  logic round, unused_carry;

  assign stays = first_i ? '0 : !opens_i ? sum_q
               : down_i ? sum_q << DigitWidth : Width'($signed(sum_q) >>> DigitWidth);
  // The digit that left was balanced: where it was negative, the columns above have one more.
  assign round = opens_i & ~first_i & ~down_i & sum_q[DigitWidth-1];
  assign product = Width'(product_i) ^ {Width{negate_i}};
  assign second  = with_second_i ? Width'(second_i) ^ {Width{subtract_second_i}} : '0;

  carry_save_adder #(
    .Width(Width)
  ) u_rows (
    .a_i    (stays),
    .b_i    (product),
    .c_i    (second),
    .sum_o  (partial),
    .carry_o(carries)
  );

  adder #(
    .Width(Width),
    .Arith(Arith),
    .Adder(Adder)
  ) u_adder (
    .a_i    (partial),
    .b_i    (carries | Width'(round)),
    .carry_i(with_second_i ? subtract_second_i : negate_i),
    .sum_o  (sum_d),
    .carry_o(unused_carry)
  );

  always_ff @(posedge clk_i) sum_q <= sum_d;

  // ---- The digit as a sign and a magnitude

  logic [DigitWidth-1:0] digit;

  assign negative_o = sum_q[DigitWidth-1];
  assign digit      = sum_q[DigitWidth-1:0] ^ {DigitWidth{negative_o}};

  incrementer #(
    .Width(DigitWidth),
    .Arith(Arith)
  ) u_magnitude (
    .a_i    (digit),
    .carry_i(negative_o),
    .sum_o  (magnitude_o)
  );

  // ---- The sum's sign

  assign sum_negative_o = sum_q[Width-1];
  assign sum_zero_o     = sum_q == '0;
  assign sure_o         = (sum_q[Width-1:SureBit] != '0) & ~(&sum_q[Width-1:SureBit]);

endmodule
