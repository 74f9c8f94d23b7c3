// The float cores cut into stages, of both kinds of arithmetic, on one stream of operands.
//
// sum_o, product_o and quotient_o are those of the structural cores in one piece, Latency clocks later,
// flags below the number. A bit of differ_*_o is set where a core
// that is cut, or behavioural, then gives something else. The rounding mode must stay for Latency clocks.
module stages_top #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth,
  localparam int unsigned Latency = (FracWidth + 2) / 2 + 5
) (
  input  logic             clk_i,
  input  logic [Width-1:0] a_i,
  input  logic [Width-1:0] b_i,
  input  logic             subtract_i,
  input  logic             valid_i,          // of the pipelined dividers' operands
  input  logic [2:0]       rounding_mode_i,
  input  logic             tininess_after_i,
  output logic [Width+4:0] sum_o,
  output logic [Width+4:0] product_o,
  output logic [Width+4:0] quotient_o,
  output logic [9:0]       differ_sum_o,
  output logic [9:0]       differ_product_o,
  output logic [3:0]       differ_quotient_o,
  output logic             valid_o
);

  // Structural with every set of cuts, then behavioural with none and all: cuts in the low bits.
  localparam bit [4*10-1:0] AdderKinds = {
    4'hf, 4'h8, 4'h7, 4'h6, 4'h5, 4'h4, 4'h3, 4'h2, 4'h1, 4'h0
  };
  localparam bit [4*10-1:0] MultiplierKinds = {
    4'hf, 4'h8, 4'h7, 4'h6, 4'h5, 4'h4, 4'h3, 4'h2, 4'h1, 4'h0
  };

  for (genvar n = 0; n < 10; n++) begin : gen_adder
    localparam bit [2:0] PipeRegs = AdderKinds[4*n +: 3];
    logic [Width+4:0] result, late;

    fp_adder_stages #(
      .ExpWidth(ExpWidth), .FracWidth(FracWidth), .Arith(32'(AdderKinds[4*n+3])), .PipeRegs(PipeRegs)
    ) u_adder (
      .clk_i, .a_i, .b_i, .subtract_i, .rounding_mode_i, .tininess_after_i,
      .result_o(result[Width+4:5]), .flags_o(result[4:0]));
    delay_line #(
      .Width(Width + 5), .Depth(Latency - 32'(PipeRegs[0]) - 32'(PipeRegs[1]) - 32'(PipeRegs[2]))
    ) u_late (.clk_i, .enable_i(1'b1), .data_i(result), .data_o(late));
    assign differ_sum_o[n] = late != sum_o;
  end
  assign sum_o = gen_adder[0].late;

  for (genvar n = 0; n < 10; n++) begin : gen_multiplier
    localparam bit [2:0] PipeRegs = MultiplierKinds[4*n +: 3];
    logic [Width+4:0] result, late;

    fp_multiplier_stages #(
      .ExpWidth(ExpWidth), .FracWidth(FracWidth),
      .Arith(32'(MultiplierKinds[4*n+3])), .PipeRegs(PipeRegs)
    ) u_multiplier (
      .clk_i, .a_i, .b_i, .rounding_mode_i, .tininess_after_i,
      .result_o(result[Width+4:5]), .flags_o(result[4:0]));
    delay_line #(
      .Width(Width + 5), .Depth(Latency - 32'(PipeRegs[0]) - 32'(PipeRegs[1]) - 32'(PipeRegs[2]))
    ) u_late (.clk_i, .enable_i(1'b1), .data_i(result), .data_o(late));
    assign differ_product_o[n] = late != product_o;
  end
  assign product_o = gen_multiplier[0].late;

  delay_line #(.Width(1), .Depth(Latency)) u_valid (
    .clk_i, .enable_i(1'b1), .data_i(valid_i), .data_o(valid_o));
  for (genvar n = 0; n < 4; n++) begin : gen_divider
    logic [Width+4:0] result, late;

    fp_divider_stages #(
      .ExpWidth(ExpWidth), .FracWidth(FracWidth), .Arith(n / 2), .PipeRegs({32{n % 2 == 1}})
    ) u_divider (
      .clk_i, .valid_i, .a_i, .b_i, .rounding_mode_i, .tininess_after_i,
      .result_o(result[Width+4:5]), .flags_o(result[4:0]));
    delay_line #(
      .Width(Width + 5), .Depth(n % 2 == 1 ? 0 : Latency)
    ) u_late (.clk_i, .enable_i(1'b1), .data_i(result), .data_o(late));
    assign differ_quotient_o[n] = valid_o & (late != quotient_o);
  end
  assign quotient_o = gen_divider[0].late;

endmodule
