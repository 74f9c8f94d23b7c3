// Multiplies vectors word by word, product[n] = a[n] b[n], with few multipliers that take turns; rounded to nearest.
//
// step_i is high in one of Clocks clocks: with it words come in, and those that came in with the step before go out.
// Latency: a step. A multiplier has Clocks - 3 words in a step. Takes every bit pattern; no flags.
module fp_vector_multiplier #(
  parameter int unsigned ExpWidth = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Words = 3,
  parameter int unsigned Clocks = 9,
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic                   clk_i,
  input  logic                   step_i,
  input  logic [Words*Width-1:0] a_i,
  input  logic [Words*Width-1:0] b_i,
  output logic [Words*Width-1:0] product_o
);

  localparam int unsigned Share = Clocks - 3;  // of words a multiplier
  localparam int unsigned Units = (Words + Share - 1) / Share;

  if (Clocks < 5) begin : gen_check
    $error("fp_vector_multiplier: expected 5 Clocks or more");
  end

  for (genvar u = 0; u < Units; u++) begin : gen_unit
    localparam int unsigned First = Share * u;
    localparam int unsigned Own = (Words - First < Share) ? Words - First : Share;
    logic [Own*Width-1:0] a_q, b_q;  // the word whose turn it is lowest
    logic [Width-1:0] product;
    logic [(Share-1)*Width-1:0] products_q;  // the latest highest
    logic [Share*Width-1:0] products;
    fp_pkg::flags_t unused_flags;

    always_ff @(posedge clk_i) begin
      if (step_i) {a_q, b_q} <= {a_i[Width*First+:Width*Own], b_i[Width*First+:Width*Own]};
      else {a_q, b_q} <= {a_q >> Width, b_q >> Width};
      products_q <= products[Share*Width-1:Width];
    end

    fp_multiplier_stages #(
      .ExpWidth(ExpWidth),
      .FracWidth(FracWidth),
      .Arith(Arith),
      .Adder(Adder),
      .PipeRegs(3'b111)
    ) u_multiplier (
      .clk_i,
      .a_i(a_q[Width-1:0]),
      .b_i(b_q[Width-1:0]),
      .rounding_mode_i(fp_pkg::RoundNearestEven),
      .tininess_after_i(1'b0),
      .result_o(product),
      .flags_o(unused_flags)
    );
    assign products = {product, products_q};
    assign product_o[Width*First +: Width*Own] = products[Width*Own-1:0];
  end

endmodule
