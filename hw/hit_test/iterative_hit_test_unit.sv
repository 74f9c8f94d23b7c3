// The paper's hit-test unit with a short clock: where a ray meets a polygon's plane, P = d I / (I . N). Its cores are
// pipelined. The words on its bus, its throughput and its results are those of hit_test_unit.
//
// One multiplier computes six products, one adder two sums, and one divider three quotients with the divisor I . N.
// Their latencies are M = 3, A = 3 and D = divide_latency. Clocks count from the first word's clock edge:
//
//   clock      event
//   1-3        Ix Iy Iz shift into I-3, I-2, I-1, which rotate while they are multiplied
//   4-7        a, b, c, d into the factor register
//   M+4..M+9   the products a Ix, b Iy, c Iz, d Ix, d Iy, d Iz; the third and the last three are kept
//   M+A+5      (+0 + a Ix) + b Iy; as in the paper, the sum from +0 turns a Ix = -0 to +0, unless rounding down
//   M+2A+5     I . N, the divisor; the last three products are divided in the clocks after it
//   M+2A+D+6.. Px Py Pz
//
// The first word comes with valid_i high while ready_o is high; the other six words follow in consecutive clocks.
// valid_o is high, with a component on bus_o, in three consecutive clocks.
// Throughput: a test every 7 clocks. Latency: M + 2A + D + 8 clocks, 34 in binary32 (first word to last component).
// Source: the paper's equation 10; the timetable is this project's.
module iterative_hit_test_unit
  import hit_test_pkg::*;
#(
  parameter int unsigned ExpWidth = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith = arith_pkg::Graded,
  parameter bit [2:0] RoundingMode = fp_pkg::RoundNearestEven,
  localparam int unsigned Width = ExpWidth + FracWidth + 1
) (
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             valid_i,
  output logic             ready_o,
  input  logic [Width-1:0] bus_i,
  output logic [Width-1:0] bus_o,
  output logic             valid_o
);

  localparam int unsigned NumWords = 7;

  // The adder's two sums of a test must not collide with those of the next test. Three products wait for the divisor:
  // the last must arrive before the first is divided, and leave before the next test's first arrives.
  if (AdderLatency < 2 || 2 * AdderLatency - 1 > NumWords) begin : gen_check
    $error("iterative_hit_test_unit: expected an AdderLatency of 2 to (NumWords + 1) / 2");
  end

  // ---- Control: word k is taken at edge k + 1; since_q[n] is high n + 1 clocks after the last word

  localparam int unsigned ThirdProduct = MultiplierLatency - 1;
  localparam int unsigned FirstSum = MultiplierLatency + AdderLatency - 2;
  localparam int unsigned Divisor = FirstSum + AdderLatency;

  logic [2:0] word;
  logic step;
  logic [Divisor+3:1] since_q;
  logic [Divisor+3:0] since;

  hit_test_control #(
    .NumWords(NumWords),
    .NumSteps(1)
  ) u_control (
    .clk_i,
    .rst_ni,
    .valid_i,
    .ready_o,
    .word_o(word),
    .step_o(step)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) since_q <= '0;
    else since_q <= since[Divisor+2:0];
  end
  assign since = {since_q, step};

  // ---- Operands

  logic [Width-1:0] direction_1_q, direction_2_q, direction_3_q, factor_q;

  always_ff @(posedge clk_i) begin
    if (word != 3'd3) begin
      direction_3_q <= (word > 3'd3) ? direction_1_q : bus_i;
      direction_2_q <= direction_3_q;
      direction_1_q <= direction_2_q;
    end
    if (word >= 3'd3) factor_q <= bus_i;
  end

  // ---- Multiply

  logic [Width-1:0] product;

  fp_multiplier #(
    .ExpWidth (ExpWidth),
    .FracWidth(FracWidth),
    .Arith    (Arith),
    .Pipelined(1'b1)
  ) u_multiplier (
    .clk_i,
    .a_i             (factor_q),
    .b_i             (direction_1_q),
    .rounding_mode_i (RoundingMode),
    .tininess_after_i(1'b0),
    .result_o        (product),
    .flags_o         ()
  );

  logic [Width-1:0] first_q, third_q, dividend;
  logic [2:0] keep, divide;

  assign keep = since[MultiplierLatency+:3];
  assign divide = since[Divisor+1+:3];

  always_ff @(posedge clk_i) begin
    first_q <= {
      product[Width-1] & ((|product[Width-2:0]) | (RoundingMode == fp_pkg::RoundDown)),
      product[Width-2:0]
    };
    if (since[ThirdProduct]) third_q <= product;
  end
  delay_line #(
    .Width(Width),
    .Depth(3)
  ) u_dividends (
    .clk_i,
    .enable_i(|{keep, divide}),
    .data_i(product),
    .data_o(dividend)
  );

  // ---- Add

  logic [Width-1:0] sum;

  fp_adder #(
    .ExpWidth (ExpWidth),
    .FracWidth(FracWidth),
    .Arith    (Arith),
    .Pipelined(1'b1)
  ) u_adder (
    .clk_i,
    .a_i             (since[FirstSum] ? sum : first_q),
    .b_i             (since[FirstSum] ? third_q : product),
    .subtract_i      (1'b0),
    .rounding_mode_i (RoundingMode),
    .tininess_after_i(1'b0),
    .result_o        (sum),
    .flags_o         ()
  );

  // ---- Divide

  localparam int unsigned Latency = divide_latency(FracWidth);
  logic [Width-1:0] divisor_q;
  logic [Latency-1:0] dividing_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) dividing_q <= '0;
    else dividing_q <= {dividing_q[Latency-2:0], |divide};
  end
  always_ff @(posedge clk_i) if (since[Divisor]) divisor_q <= sum;
  assign valid_o = dividing_q[Latency-1];

  fp_divider #(
    .ExpWidth (ExpWidth),
    .FracWidth(FracWidth),
    .Arith    (Arith),
    .Pipelined(1'b1)
  ) u_divider (
    .clk_i,
    .valid_i         (|divide),
    .a_i             (dividend),
    .b_i             (divisor_q),
    .rounding_mode_i (RoundingMode),
    .tininess_after_i(1'b0),
    .result_o        (bus_o),
    .flags_o         ()
  );

endmodule
