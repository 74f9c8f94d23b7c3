// The paper's hit-test unit: where a ray meets a polygon's plane. P = d I / (I . N), relative to the ray's origin, with
// one multiplier, one adder, one divider, eight registers and two multiplexers.
//
// I = (Ix, Iy, Iz) is the ray's direction, N = (a, b, c) the plane's normal (the paper's H), and d = N . V for a vertex
// V of the polygon. Seven words come in, three go out. As in figure 4, the bus feeds only N and d, and N feeds I-3 or
// the multiplier:
//
//   edge   bus in       what happens at this clock edge
//   1-3    Ix Iy Iz     each into N
//   2-4                 N into I-3, then I-2 and I-1: after edge 4, I-3 to I-1 hold Iz, Iy, Ix
//   4-6    a b c        each into N; the accumulator is cleared at edge 4
//   5-7                 N * I-1 added to the accumulator; at edge 7 the sum into the divisor; I-1 into I-3
//   7      d            into d
//   8-10   the next I   (d * I-1) / divisor into Output: Px Py Pz; the next I follows through N
//
// I-3, I-2 and I-1 shift at every edge. Iz reaches I-3 at edge 4, when the first factor, a, reaches N. So the path
// through N costs no clock. (The paper's section 4.2 counts the 8 clocks until Px.)
//
// The first word comes with valid_i high while ready_o is high; the other six words follow in consecutive clocks.
// valid_o is high, with a component on bus_o, in the clock after each of edges 8, 9 and 10.
// Throughput: a test every 7 clocks. Latency: 10 clocks (from first word to last component).
//
// Each operation is rounded once, in RoundingMode, in the order of the table, and conforms to IEEE 754; the accumulator
// starts from +0. A ray parallel to the plane gives infinities, or NaN for components in which d I is zero too.
// QuotientBits = 21 truncates quotients as the paper's divider did; 0 rounds them.
// Source: the paper's equation 10, figures 4 and 9.
module hit_test_unit #(
  parameter int unsigned ExpWidth = 8,
  parameter int unsigned FracWidth = 23,
  parameter int unsigned Arith = arith_pkg::Graded,
  parameter int unsigned QuotientBits = 0,
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

  // ---- Control: word k is taken at edge k + 1, step k ends with edge k + 7

  logic [2:0] word;
  logic [1:0] step;
  logic load_d, clear, accumulate, divide;

  hit_test_control #(
    .NumWords(7),
    .NumSteps(3)
  ) u_control (
    .clk_i,
    .rst_ni,
    .valid_i,
    .ready_o,
    .word_o(word),
    .step_o(step)
  );

  assign clear = word == 3'd3;
  assign accumulate = word >= 3'd4;
  assign load_d = word == 3'd6;
  assign divide = step != '0;

  // ---- The eight registers

  logic [Width-1:0] direction_1_q, direction_2_q, direction_3_q;  // the paper's I-1, I-2, I-3
  logic [Width-1:0] normal_q, d_q, accumulator_q, divisor_q, output_q;

  // ---- Multiplier, adder, divider and the two multiplexers

  logic [Width-1:0] direction_in, factor, product, sum, quotient;

  assign direction_in = accumulate ? direction_1_q : normal_q;
  assign factor = accumulate ? normal_q : d_q;

  fp_multiplier #(
    .ExpWidth   (ExpWidth),
    .FracWidth  (FracWidth),
    .Arith      (Arith),
    .ConstantRow(1'b1)  // the paper's carry-save tree
  ) u_multiplier (
    .clk_i,
    .a_i             (factor),
    .b_i             (direction_1_q),
    .rounding_mode_i (RoundingMode),
    .tininess_after_i(1'b1),
    .result_o        (product),
    .flags_o         ()
  );

  fp_adder #(
    .ExpWidth (ExpWidth),
    .FracWidth(FracWidth),
    .Arith    (Arith)
  ) u_adder (
    .clk_i,
    .a_i             (accumulator_q),
    .b_i             (product),
    .subtract_i      (1'b0),
    .rounding_mode_i (RoundingMode),
    .tininess_after_i(1'b1),
    .result_o        (sum),
    .flags_o         ()
  );

  fp_divider #(
    .ExpWidth    (ExpWidth),
    .FracWidth   (FracWidth),
    .Arith       (Arith),
    .QuotientBits(QuotientBits)
  ) u_divider (
    .clk_i,
    .valid_i         (1'b1),
    .a_i             (product),
    .b_i             (divisor_q),
    .rounding_mode_i (RoundingMode),
    .tininess_after_i(1'b1),
    .result_o        (quotient),
    .flags_o         ()
  );

  always_ff @(posedge clk_i) begin
    direction_3_q <= direction_in;
    direction_2_q <= direction_3_q;
    direction_1_q <= direction_2_q;
    if (load_d) begin
      d_q <= bus_i;
      divisor_q <= sum;
    end else begin
      normal_q <= bus_i;
    end
    if (clear) accumulator_q <= '0;
    else if (accumulate) accumulator_q <= sum;
    if (divide) output_q <= quotient;
  end

  // ---- Output

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_o <= 1'b0;
    else valid_o <= divide;
  end
  assign bus_o = output_q;

endmodule
