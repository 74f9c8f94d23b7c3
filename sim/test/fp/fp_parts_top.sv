// What the float cores share: fp_unpack, fp_normalize and fp_round, the last of both kinds of arithmetic
// and with its subnormal shift and without, in binary32.
module fp_parts_top (
  input  logic [31:0] packed_i,
  output logic        sign_o,
  output logic [7:0]  exponent_o,
  output logic [23:0] significand_o,
  output logic [4:0]  class_o,          // special, zero, infinity, NaN, signalling NaN
  output logic [23:0] normal_o,         // significand_o, normalised
  output logic [4:0]  count_o,
  input  logic        round_sign_i,
  input  logic [9:0]  round_exponent_i,
  input  logic [27:0] round_significand_i,
  input  logic [4:0]  specials_i,       // NaN, infinity, zero, invalid, division by zero
  input  logic [2:0]  rounding_mode_i,
  input  logic        tininess_after_i,
  output logic [63:0] rounded_o,        // 32 bits each: structural, behavioural
  output logic [9:0]  flags_o,
  output logic [63:0] in_place_o,       // the same without the subnormal shift
  output logic [9:0]  in_place_flags_o
);

  fp_unpack u_unpack (
    .packed_i, .sign_o, .exponent_o, .significand_o, .special_o(class_o[4]), .zero_o(class_o[3]),
    .infinity_o(class_o[2]), .nan_o(class_o[1]), .signaling_nan_o(class_o[0]));
  fp_normalize u_normalize (.significand_i(significand_o), .significand_o(normal_o), .count_o);

  for (genvar n = 0; n < 2; n++) begin : gen_kind
    fp_round #(.Arith(n)) u_round (
      .sign_i(round_sign_i), .exponent_i(round_exponent_i), .significand_i(round_significand_i),
      .nan_i(specials_i[4]), .infinity_i(specials_i[3]), .zero_i(specials_i[2]),
      .invalid_i(specials_i[1]), .divide_by_zero_i(specials_i[0]), .rounding_mode_i,
      .tininess_after_i, .result_o(rounded_o[32*n +: 32]), .flags_o(flags_o[5*n +: 5]));
    fp_round #(.SubnormalShift(1'b0), .Arith(n)) u_in_place (
      .sign_i(round_sign_i), .exponent_i(round_exponent_i), .significand_i(round_significand_i),
      .nan_i(specials_i[4]), .infinity_i(specials_i[3]), .zero_i(specials_i[2]),
      .invalid_i(specials_i[1]), .divide_by_zero_i(specials_i[0]), .rounding_mode_i,
      .tininess_after_i, .result_o(in_place_o[32*n +: 32]), .flags_o(in_place_flags_o[5*n +: 5]));
  end

endmodule
