// The general form of the hit test, for comparison: t = -(d + N . O) / (N . I), P = O + t I, for a ray from any origin
// O, with one multiplier, one adder and one divider: the cores of hit_test_unit.
//
// N = (a, b, c) and d give the plane N . P + d = 0 (so d has the opposite sign of hit_test_unit's d). I is the ray's
// direction. Ten words come in, three go out:
//
//   edge    bus in      what happens at this clock edge
//   1       d           into the accumulator
//   2-4     a b c       shift into N-3, N-2, N-1
//   5-7     Ox Oy Oz    shift into V-6 ... V-1
//   6-8                 accumulator + N-1 * V-6 into the accumulator, at edge 8 into the numerator; N rotates
//   8-10    Ix Iy Iz    shift into V-6 ... V-1, which then hold I and O
//   9-11                N-1 * V-6 into the accumulator, then added to it, at edge 11 into the divisor; N rotates
//   12                  -numerator / divisor into t
//   13-15   the next N  V-1 + t * V-4 into Output: Px Py Pz; V shifts
//
// The first word comes with valid_i high while ready_o is high; the other nine words follow in consecutive clocks.
// valid_o is high, with a component on bus_o, in the clock after each of edges 13, 14 and 15.
// Throughput: a test every 10 clocks: ten words on one bus; the multiplier works in 9 of them.
// Latency: 15 clocks (the minimum if a clock has time for a multiplication and an addition, or for a division).
//
// Operations: 9 multiplications, 8 additions, 1 division, rounded as in hit_test_unit.
// Source: the paper's equations 4 and 5; the timetable is this project's.
module general_hit_test_unit #(
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

  // ---- Control: word k is taken at edge k + 1, step k ends with edge k + 10

  logic [3:0] word;
  logic [2:0] step;
  logic load_d, load_normal, load_vectors, dot_origin, dot_direction, dot_first, dot_last;
  logic divide, move;

  hit_test_control #(
    .NumWords(10),
    .NumSteps(5)
  ) u_control (
    .clk_i,
    .rst_ni,
    .valid_i,
    .ready_o,
    .word_o(word),
    .step_o(step)
  );

  assign load_d = word == 4'd0;
  assign load_normal = word >= 4'd1 && word <= 4'd3;
  assign load_vectors = word >= 4'd4;
  assign dot_origin = word >= 4'd5 && word <= 4'd7;
  assign dot_direction = word >= 4'd8 || dot_last;
  assign dot_first = word == 4'd8;
  assign dot_last = step == 3'd1;
  assign divide = step == 3'd2;
  assign move = step >= 3'd3;  // from the origin along the ray

  // ---- Registers

  logic [Width-1:0] normal_1_q, normal_2_q, normal_3_q;
  logic [Width-1:0] vector_1_q, vector_2_q, vector_3_q, vector_4_q, vector_5_q, vector_6_q;
  logic [Width-1:0] accumulator_q, numerator_q, divisor_q, t_q, output_q;

  // ---- Multiplier, adder, divider and their multiplexers

  logic [Width-1:0] factor, coordinate, addend, product, sum, quotient;

  assign factor = move ? t_q : normal_1_q;
  assign coordinate = move ? vector_4_q : vector_6_q;
  assign addend = move ? vector_1_q : accumulator_q;

  fp_multiplier #(
    .ExpWidth   (ExpWidth),
    .FracWidth  (FracWidth),
    .Arith      (Arith),
    .ConstantRow(1'b1)  // the paper's carry-save tree
  ) u_multiplier (
    .clk_i,
    .a_i             (factor),
    .b_i             (coordinate),
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
    .a_i             (addend),
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
    .a_i             ({~numerator_q[Width-1], numerator_q[Width-2:0]}),
    .b_i             (divisor_q),
    .rounding_mode_i (RoundingMode),
    .tininess_after_i(1'b1),
    .result_o        (quotient),
    .flags_o         ()
  );

  always_ff @(posedge clk_i) begin
    if (load_normal || dot_origin || dot_direction) begin
      normal_3_q <= load_normal ? bus_i : normal_1_q;
      normal_2_q <= normal_3_q;
      normal_1_q <= normal_2_q;
    end
    if (load_vectors || move) begin
      vector_6_q <= bus_i;
      vector_5_q <= vector_6_q;
      vector_4_q <= vector_5_q;
      vector_3_q <= vector_4_q;
      vector_2_q <= vector_3_q;
      vector_1_q <= vector_2_q;
    end
    if (load_d) accumulator_q <= bus_i;
    else if (dot_first) accumulator_q <= product;
    else if (dot_origin || dot_direction) accumulator_q <= sum;
    if (word == 4'd7) numerator_q <= sum;
    if (dot_last) divisor_q <= sum;
    if (divide) t_q <= quotient;
    if (move) output_q <= sum;
  end

  // ---- Output

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_o <= 1'b0;
    else valid_o <= move;
  end
  assign bus_o = output_q;

endmodule
