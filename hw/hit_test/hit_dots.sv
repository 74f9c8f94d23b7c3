// Dot products of a hit test: V = N . I and U_k = E_k . I of a polygon record, and d I_k, the dividends of its P.
//
// A dot product is (x + y) + z, rounded after each operation. Clocks and steps: see fp_vector. Latency: DotLatency
// clocks, or three steps. Throughput: a test a clock, or a step. Accepts every bit pattern.
//
// Each coordinate of I multiplies five words. It is the operand that the multipliers recode (b_i of booth_multiplier),
// so tools merge the five equal recoders.
module hit_dots
  import hit_test_pkg::*;
#(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith     = arith_pkg::Graded,
  parameter bit [2:0]    RoundingMode = 3'd0,
  parameter int unsigned Clocks    = 1,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic               clk_i,
  input  logic               step_i,
  input  logic [3*Width-1:0] normal_i,
  input  logic [9*Width-1:0] edges_i,
  input  logic [Width-1:0]   d_i,
  input  logic [3*Width-1:0] direction_i,
  output logic [Width-1:0]   v_o,
  output logic [3*Width-1:0] u_o,
  output logic [3*Width-1:0] dividends_o
);

  // Latency of an operation, in clocks or steps
  localparam int unsigned Operation = (Clocks == 1) ? AdderLatency : 1;
  localparam int unsigned Scaled = 5;  // words that a coordinate of I multiplies: N's, E_k's, d
  logic [3*Scaled*Width-1:0] words, factors, scaled;
  logic [4*Width-1:0] thirds, sums, first;

  for (genvar k = 0; k < 3; k++) begin : gen_coordinate
    assign words[Width*Scaled*k+:Width*Scaled] = {
      d_i,
      edges_i[Width*(6+k)+:Width],
      edges_i[Width*(3+k)+:Width],
      edges_i[Width*k+:Width],
      normal_i[Width*k+:Width]
    };
    assign factors[Width*Scaled*k+:Width*Scaled] = {Scaled{direction_i[Width*k+:Width]}};
  end

  fp_vector #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .Words(3 * Scaled),
    .Multiply(1'b1),
    .Clocks(Clocks),
    .RoundingMode(RoundingMode),
    .Arith(Arith)
  ) u_scale (
    .clk_i,
    .step_i,
    .a_i(words),
    .b_i(factors),
    .result_o(scaled)
  );

  // ---- x + y, then + z

  delay_line #(
    .Width(4 * Width),
    .Depth(Operation)
  ) u_thirds (
    .clk_i,
    .enable_i(step_i),
    .data_i(scaled[Width*2*Scaled +: 4*Width]),
    .data_o(thirds)
  );
  fp_vector #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .Words(8),
    .Clocks(Clocks),
    .RoundingMode(RoundingMode),
    .Arith(Arith)
  ) u_sums (
    .clk_i,
    .step_i,
    .a_i({first, scaled[0 +: 4*Width]}),
    .b_i({thirds, scaled[Width*Scaled +: 4*Width]}),
    .result_o({sums, first})
  );
  assign {u_o, v_o} = sums;

  delay_line #(
    .Width(3 * Width),
    .Depth(2 * Operation)
  ) u_dividends (
    .clk_i,
    .enable_i(step_i),
    .data_i({scaled[Width*14 +: Width], scaled[Width*9 +: Width], scaled[Width*4 +: Width]}),
    .data_o(dividends_o)
  );

endmodule
