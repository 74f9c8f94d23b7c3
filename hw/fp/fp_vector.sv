// Adds, subtracts or multiplies vectors word by word: result[n] = a[n] op b[n].
//
// Latency: 3 clocks, or one step. Multiply = 1: products; 0: sums, or differences for words with a 1 in Subtract.
// * Clocks = 1: each word has a core (adder or multiplier). A vector is taken in every clock; step_i is ignored.
// * Clocks of 5 or more: Clocks - 3 words share a core. A clock edge with step_i high takes a vector; result_o then
//   holds the results of the vector taken one step before. step_i must be high in one of every Clocks clocks.
// Accepts all bit patterns.
module fp_vector #(
  parameter int unsigned ExpWidth = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Words = 3,
  parameter bit Multiply = 1'b0,
  parameter bit [Words-1:0] Subtract = '0,
  parameter int unsigned Clocks = 1,
  parameter bit [2:0] RoundingMode = 3'd0,
  parameter int unsigned Arith = arith_pkg::Graded,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic                   clk_i,
  input  logic                   step_i,
  input  logic [Words*Width-1:0] a_i,
  input  logic [Words*Width-1:0] b_i,
  output logic [Words*Width-1:0] result_o
);

  localparam int unsigned Share = (Clocks == 1) ? 1 : Clocks - 3;  // words per core
  localparam int unsigned Units = (Words + Share - 1) / Share;

  if (Clocks != 1 && Clocks < 5) begin : gen_check
    $error("fp_vector: expected Clocks of 1, or 5 or more");
  end

  for (genvar u = 0; u < Units; u++) begin : gen_unit
    localparam int unsigned First = Share * u;
    localparam int unsigned Own = (Words - First < Share) ? Words - First : Share;
    logic [Width-1:0] a, b, result;
    logic subtract;

    if (Clocks == 1) begin : gen_own
      logic unused_step;
      assign unused_step = step_i;
      assign {a, b} = {a_i[Width*u+:Width], b_i[Width*u+:Width]};
      assign subtract = Subtract[u];
      assign result_o[Width*u+:Width] = result;
    end else begin : gen_turns
      logic [Own*Width-1:0] a_q, b_q;  // lowest: the word that enters the core
      logic [Own-1:0] subtract_q;
      logic [(Share-1)*Width-1:0] results_q;  // the latest result highest
      logic [Share*Width-1:0] results;

      always_ff @(posedge clk_i) begin
        if (step_i) begin
          {a_q, b_q} <= {a_i[Width*First+:Width*Own], b_i[Width*First+:Width*Own]};
          subtract_q <= Subtract[First+:Own];
        end else begin
          {a_q, b_q} <= {a_q >> Width, b_q >> Width};
          subtract_q <= subtract_q >> 1;
        end
        results_q <= results[Share*Width-1:Width];
      end
      assign {a, b, subtract} = {a_q[Width-1:0], b_q[Width-1:0], subtract_q[0]};
      assign results = {result, results_q};
      assign result_o[Width*First+:Width*Own] = results[Width*Own-1:0];
    end

    if (Multiply) begin : gen_multiplier
      logic unused_subtract;
      assign unused_subtract = subtract;

      fp_multiplier #(
        .ExpWidth(ExpWidth),
        .FracWidth(FracWidth),
        .Arith(Arith),
        .Pipelined(1'b1)
      ) u_core (
        .clk_i,
        .a_i(a),
        .b_i(b),
        .rounding_mode_i(RoundingMode),
        .tininess_after_i(1'b0),
        .result_o(result),
        .flags_o()
      );
    end else begin : gen_adder
      fp_adder #(
        .ExpWidth(ExpWidth),
        .FracWidth(FracWidth),
        .Arith(Arith),
        .Pipelined(1'b1)
      ) u_core (
        .clk_i,
        .a_i(a),
        .b_i(b),
        .subtract_i(subtract),
        .rounding_mode_i(RoundingMode),
        .tininess_after_i(1'b0),
        .result_o(result),
        .flags_o()
      );
    end
  end

endmodule
