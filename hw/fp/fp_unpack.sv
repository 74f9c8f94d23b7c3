// Takes one IEEE number apart: fields, hidden bit, class.
//
// value = (-1)**sign_o * significand_o / 2**FracWidth * 2**(exponent_o - bias) for every finite
// number: a subnormal or zero has hidden bit 0 and the exponent of the smallest normal one, and is
// not normalised here. Infinities and NaNs have the exponent field as it is, and mean nothing by
// their value.
//
// Combinational; takes every bit pattern. Source: IEEE 754-2019, clause 3.4.
module fp_unpack #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23
) (
  input  logic [ExpWidth+FracWidth:0] packed_i,
  output logic                        sign_o,
  output logic [ExpWidth-1:0]         exponent_o,      // biased, 1 or more
  output logic [FracWidth:0]          significand_o,   // one integer bit
  output fp_pkg::class_t              class_o
);

  logic [ExpWidth-1:0] field;
  logic [FracWidth-1:0] fraction;
  logic field_zero, field_ones, fraction_zero, special;

  assign {sign_o, field, fraction} = packed_i;
  assign field_zero = field == '0;
  assign field_ones = &field;
  assign fraction_zero = fraction == '0;

  assign exponent_o = {field[ExpWidth-1:1], field[0] | field_zero};
  assign significand_o = {~field_zero, fraction};
  assign special = field_ones | (packed_i[ExpWidth+FracWidth-1:0] == '0);

  always_comb begin
    class_o = '0;
    if (special) begin
      class_o.special = 1'b1;
      class_o.zero = field_zero;
      class_o.infinity = field_ones & fraction_zero;
      class_o.nan = field_ones & ~fraction_zero;
      class_o.signaling_nan = field_ones & ~fraction_zero & ~fraction[FracWidth-1];
    end
  end

endmodule
