// Shifts the leading one of a significand to its top bit, and says how far that was.
//
// For dividing subnormals; a normal significand passes with count_o = 0. For zero
// the outputs mean nothing. Combinational.
module fp_normalize #(
  parameter int unsigned Width = 24
) (
  input  logic [Width-1:0]         significand_i,
  output logic [Width-1:0]         significand_o,
  output logic [$clog2(Width)-1:0] count_o
);

  logic unused_zero;

  leading_zero_counter #(
    .Width(Width)
  ) u_count (
    .a_i(significand_i),
    .count_o,
    .zero_o(unused_zero)
  );
  assign significand_o = significand_i << count_o;

endmodule
