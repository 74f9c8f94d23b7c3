// Multiplies vectors word by word, product[n] = a[n] b[n]; binary32, rounded to nearest.
// Latency: hit_test_pkg::MultiplierLatency, throughput one a clock. Takes every bit pattern; no flags.
module vec_mul #(
  parameter int unsigned Words = 3,
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded
) (
  input  logic                clk_i,
  input  logic [32*Words-1:0] a_i,
  input  logic [32*Words-1:0] b_i,
  output logic [32*Words-1:0] product_o
);

  for (genvar n = 0; n < Words; n++) begin : gen_word
    fp_pkg::flags_t unused_flags;

    fp_multiplier_stages #(
      .Arith(Arith),
      .Adder(Adder),
      .PipeRegs(hit_test_pkg::MultiplierPipeRegs)
    ) u_multiplier (
      .clk_i,
      .a_i(a_i[32*n +: 32]),
      .b_i(b_i[32*n +: 32]),
      .rounding_mode_i(fp_pkg::RoundNearestEven),
      .tininess_after_i(1'b0),
      .result_o(product_o[32*n +: 32]),
      .flags_o(unused_flags)
    );
  end

endmodule
