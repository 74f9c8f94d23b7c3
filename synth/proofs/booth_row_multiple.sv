// Composition of the multiplier's proof, step 2. Claim: a row (partial product) is its digit times operand a:
// row + n - n * 2**(Width+1) = digit * a, n being `negative`; modulo 2**(Width+3), these values are distinct.
module booth_row_multiple #(
  parameter int unsigned Width = 24
) (
  input logic [Width-1:0] a,
  input logic             one,
  input logic             two,
  input logic             negative
);

  logic [Width:0] row;

  booth_row #(
    .Width(Width)
  ) dut (
    .a_i       (a),
    .one_i     (one),
    .two_i     (two),
    .negative_i(negative),
    .row_o     (row)
  );

  logic [Width+2:0] magnitude, multiple, value;
  assign magnitude = one ? (Width + 3)'(a) : two ? (Width + 3)'(a) << 1 : '0;
  assign multiple  = negative ? -magnitude : magnitude;
  assign value     = (Width + 3)'(row) + (Width + 3)'(negative)
                   - ((Width + 3)'(negative) << (Width + 1));

  always_comb assert ((one && two) || value == multiple);

endmodule
