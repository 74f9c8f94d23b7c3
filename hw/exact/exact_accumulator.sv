// Accumulator of the exact unit: sums of digit products, without rounding.
//
// Product scanning (Comba, "Exponentiation cryptosystems on the IBM PC", IBM Systems Journal 29, 1990): column k has
// all products of a digit i and a digit k - i. One register holds the sum of one column at a time. (Kulisch's long
// accumulator, Computer Arithmetic and Validity, 2013, is as wide as the exponents' range.)
//
//   upwards    for a number: the low DigitWidth bits of a column's sum are a balanced digit of the number; the rest is
//              carried into the next column;
//   downwards  for a sign: the sum is multiplied by 2**DigitWidth before the next lower column is added. A column has
//              at most Products products of magnitude 2**(2 DigitWidth - 2) or less. So all lower columns together
//              change the sum by less than Products 2**(DigitWidth - 2) (1 + 2**(1 - DigitWidth)) < 2**SureBit: the
//              sign of a larger sum is final. A smaller sum stays below 2**(2 DigitWidth + log2 Products) with the next
//              column.
// Latency: 1 clock. Throughput: one term a clock (as two words, sum_i + carry_i modulo 2**Width).
module exact_accumulator
  import exact_pkg::*;
#(
  parameter int unsigned DigitWidth = 48,
  parameter int unsigned Products = 36,  // maximum number of products in a column
  parameter int unsigned Arith = arith_pkg::Graded,
  localparam int unsigned Width = sum_width(DigitWidth, Products)
) (
  input  logic                  clk_i,
  input  logic                  opens_i,  // first term of a column
  input  logic                  first_i,  // first term of a sum
  input  logic                  down_i,
  input  logic [Width-1:0]      sum_i,
  input  logic [Width-1:0]      carry_i,
  output logic [DigitWidth-1:0] digit_o,
  output logic                  negative_o,
  output logic                  zero_o,
  output logic                  sure_o  // the sign is final, whatever the columns below
);

  localparam int unsigned SureBit = DigitWidth - 1 + $clog2(Products);

  logic [Width-1:0] sum_q, stays, partial, carries, sum_d;
  logic round;

  assign stays = first_i ? '0 : !opens_i ? sum_q
               : down_i ? sum_q << DigitWidth : Width'($signed(sum_q) >>> DigitWidth);
  // The digit is signed (balanced): if it is negative, the carry into the next column is one more.
  assign round = opens_i & ~first_i & ~down_i & sum_q[DigitWidth-1];

  carry_save_adder #(
    .Width(Width)
  ) u_rows (
    .a_i    (stays),
    .b_i    (sum_i),
    .c_i    (carry_i),
    .sum_o  (partial),
    .carry_o(carries)
  );

  adder #(
    .Width(Width),
    .Arith(Arith)
  ) u_adder (
    .a_i    (partial),
    .b_i    (carries),
    .carry_i(round),
    .sum_o  (sum_d),
    .carry_o()
  );

  always_ff @(posedge clk_i) sum_q <= sum_d;

  assign digit_o    = sum_q[DigitWidth-1:0];
  assign negative_o = sum_q[Width-1];
  assign zero_o     = sum_q == '0;
  assign sure_o     = (sum_q[Width-1:SureBit] != '0) & ~(&sum_q[Width-1:SureBit]);

endmodule
