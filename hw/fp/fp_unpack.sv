// Unpacks the two operands of an operation: fields, hidden bits, classes.
//
// A finite number is (-1)**sign_o * significand_o / 2**FracWidth * 2**(exponent_o - bias): a subnormal or zero has
// hidden bit 0 and the smallest normal exponent, and is not normalised here. Infinities and NaNs keep their
// exponent field; their value is invalid.
// Combinational; takes every bit pattern. Source: IEEE 754-2019, clause 3.4.
module fp_unpack #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23
) (
  input  logic           [1:0][ExpWidth+FracWidth:0] packed_i,
  output logic           [1:0]                       sign_o,
  output logic           [1:0][ExpWidth-1:0]         exponent_o,     // biased, 1 or more
  output logic           [1:0][FracWidth:0]          significand_o,  // one integer bit
  output fp_pkg::class_t [1:0]                       class_o
);

  for (genvar n = 0; n < 2; n++) begin : gen_operand
    logic [ExpWidth-1:0] field;
    logic [FracWidth-1:0] fraction;
    logic field_zero, field_ones, fraction_zero;
    fp_pkg::class_t kind;

    assign {sign_o[n], field, fraction} = packed_i[n];
    assign field_zero = field == '0;
    assign field_ones = &field;
    assign fraction_zero = fraction == '0;

    assign exponent_o[n] = {field[ExpWidth-1:1], field[0] | field_zero};
    assign significand_o[n] = {~field_zero, fraction};

    always_comb begin
      kind = '0;
      kind.special = field_ones | (field_zero & fraction_zero);
      if (kind.special) begin
        kind.zero = field_zero;
        kind.infinity = field_ones & fraction_zero;
        kind.nan = field_ones & ~fraction_zero;
        kind.signaling_nan = field_ones & ~fraction_zero & ~fraction[FracWidth-1];
      end
    end
    assign class_o[n] = kind;
  end

endmodule
