// Adds or subtracts vectors word by word, sum[n] = a[n] +- b[n], with few adders that take turns; rounded to nearest.
//
// step_i is high in one of Clocks clocks: with it words come in, and those that came in with the step before go out.
// Latency: a step. An adder has Clocks - 3 words in a step. Takes every bit pattern; no flags.
module fp_vector_adder #(
  parameter int unsigned ExpWidth = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Words = 3,
  parameter bit [Words-1:0] Subtract = '0,  // of these words the difference
  parameter int unsigned Clocks = 9,
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic                   clk_i,
  input  logic                   step_i,
  input  logic [Words*Width-1:0] a_i,
  input  logic [Words*Width-1:0] b_i,
  output logic [Words*Width-1:0] sum_o
);

  localparam int unsigned Share = Clocks - 3;  // of words an adder
  localparam int unsigned Units = (Words + Share - 1) / Share;

  if (Clocks < 5) begin : gen_check
    $error("fp_vector_adder: expected 5 Clocks or more");
  end

  for (genvar u = 0; u < Units; u++) begin : gen_unit
    localparam int unsigned First = Share * u;
    localparam int unsigned Own = (Words - First < Share) ? Words - First : Share;
    logic [Own*Width-1:0] a_q, b_q;  // the word whose turn it is lowest
    logic [Own-1:0] subtract_q;
    logic [Width-1:0] sum;
    logic [(Share-1)*Width-1:0] sums_q;  // the latest highest
    logic [Share*Width-1:0] sums;
    fp_pkg::flags_t unused_flags;

    always_ff @(posedge clk_i) begin
      if (step_i) begin
        {a_q, b_q} <= {a_i[Width*First+:Width*Own], b_i[Width*First+:Width*Own]};
        subtract_q <= Subtract[First+:Own];
      end else begin
        {a_q, b_q} <= {a_q >> Width, b_q >> Width};
        subtract_q <= subtract_q >> 1;
      end
      sums_q <= sums[Share*Width-1:Width];
    end

    fp_adder_stages #(
      .ExpWidth(ExpWidth),
      .FracWidth(FracWidth),
      .Arith(Arith),
      .Adder(Adder),
      .PipeRegs(3'b111)
    ) u_adder (
      .clk_i,
      .a_i(a_q[Width-1:0]),
      .b_i(b_q[Width-1:0]),
      .subtract_i(subtract_q[0]),
      .rounding_mode_i(fp_pkg::RoundNearestEven),
      .tininess_after_i(1'b0),
      .result_o(sum),
      .flags_o(unused_flags)
    );
    assign sums = {sum, sums_q};
    assign sum_o[Width*First +: Width*Own] = sums[Width*Own-1:0];
  end

endmodule
