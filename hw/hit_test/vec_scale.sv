// Multiplies a vector by a scalar: product[n] = word[n] * factor.
// Latency: hit_test_pkg::MultiplierLatency, throughput one factor a clock.
//
// The factor is what the multipliers recode, alike in all of them: tools keep one recoder. Takes every bit pattern;
// no flags.
module vec_scale #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = arith_pkg::Structural,
  parameter int unsigned Adder     = arith_pkg::AdderGraded,
  parameter bit [2:0]    RoundingMode = 3'd0,
  parameter int unsigned Words     = 5,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic                   clk_i,
  input  logic [Words*Width-1:0] words_i,
  input  logic [Width-1:0]       factor_i,
  output logic [Words*Width-1:0] products_o
);

  for (genvar n = 0; n < Words; n++) begin : gen_word
    fp_pkg::flags_t unused_flags;

    fp_multiplier_stages #(
      .ExpWidth(ExpWidth),
      .FracWidth(FracWidth),
      .Arith(Arith),
      .Adder(Adder),
      .PipeRegs(hit_test_pkg::MultiplierPipeRegs)
    ) u_multiplier (
      .clk_i,
      .a_i(words_i[Width*n +: Width]),
      .b_i(factor_i),
      .rounding_mode_i(RoundingMode),
      .tininess_after_i(1'b0),
      .result_o(products_o[Width*n +: Width]),
      .flags_o(unused_flags)
    );
  end

endmodule
