// One row of the radix-4 SRT divider: chooses a quotient digit, w' = 4 w - digit * d.
//
// Residuals are in carry-save form: w = sum + carry, modulo 4, two integer bits (the upper one is
// the sign) and Width - 2 fraction bits. d is in [1, 2) in the same places. |w| <= 2/3 d goes in
// and comes out. The digit joins those so far from below, in two words of which one is subtracted
// from the other in the end: positives_o those of positive sign, negatives_o those of negative.
//
// beside_i goes along and comes out as beside_o.
//
// Pipelined = 0: combinational. Pipelined = 1: the outputs are registers, loaded with enable_i. The row
// is written as what they load: it costs a simulation nothing while they don't.
module srt_row #(
  parameter int unsigned Width = 25,
  parameter int unsigned DigitsWidth = 2,  // of the digits so far
  parameter int unsigned BesideWidth = 1,
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  parameter bit          Pipelined = 1'b0
) (
  input  logic                   clk_i,
  input  logic                   enable_i,
  input  logic [Width-1:0]       sum_i,
  input  logic [Width-1:0]       carry_i,
  input  logic [Width-1:0]       divisor_i,
  input  logic [DigitsWidth-1:0] positives_i,
  input  logic [DigitsWidth-1:0] negatives_i,
  input  logic [BesideWidth-1:0] beside_i,
  output logic [Width-1:0]       sum_o,
  output logic [Width-1:0]       carry_o,
  output logic [Width-1:0]       divisor_o,
  output logic [DigitsWidth+1:0] positives_o,
  output logic [DigitsWidth+1:0] negatives_o,
  output logic [BesideWidth-1:0] beside_o
);

  localparam int unsigned EstimateWidth = 7;  // of 4 w: 4 integer bits with the sign, 3 more

  // ---- Estimate 4 w from the first bits of both words

  logic [EstimateWidth-1:0] estimate;
  logic unused_carry;

  adder #(
    .Width(EstimateWidth),
    .Arith(Arith),
    .Adder(Adder)
  ) u_estimate (
    .a_i(sum_i[Width-1-:EstimateWidth]),
    .b_i(carry_i[Width-1-:EstimateWidth]),
    .carry_i(1'b0),
    .sum_o(estimate),
    .carry_o(unused_carry)
  );

  // ---- Choose the digit: see srt_pkg; with its sign bit inverted the estimate compares as an unsigned
  // number

  localparam bit [8*8-1:0] MMinus1 = srt_pkg::thresholds(-1);
  localparam bit [8*8-1:0] M0 = srt_pkg::thresholds(0);
  localparam bit [8*8-1:0] M1 = srt_pkg::thresholds(1);
  localparam bit [8*8-1:0] M2 = srt_pkg::thresholds(2);

  // ---- And subtract digit * d: a positive digit adds the complement, and the one that completes it goes
  // to the free last place of the carries

  task automatic divide(input logic [EstimateWidth-1:0] signed_estimate, input logic [Width-1:0] a,
                        input logic [Width-1:0] b, input logic [Width-1:0] divisor,
                        output logic [Width-1:0] sum, output logic [Width-1:0] carry,
                        output logic [1:0] positive, output logic [1:0] negative);
    logic [EstimateWidth-1:0] y;
    logic [5:0] eighth;  // of the divisor, in bits of the thresholds
    logic from_minus_1, from_0, from_1, from_2;  // the digit is that or more
    logic one, two;  // its magnitude
    logic [Width-1:0] c;
    y = signed_estimate ^ {1'b1, {(EstimateWidth - 1) {1'b0}}};
    eighth = {divisor[Width-3-:3], 3'b000};
    from_minus_1 = y >= MMinus1[eighth+:EstimateWidth];
    from_0 = y >= M0[eighth+:EstimateWidth];
    from_1 = y >= M1[eighth+:EstimateWidth];
    from_2 = y >= M2[eighth+:EstimateWidth];
    one = (from_minus_1 ^ from_0) | (from_1 ^ from_2);
    two = ~from_minus_1 | from_2;
    c = (({Width{one}} & divisor) | ({Width{two}} & (divisor << 1))) ^ {Width{from_1}};
    sum = a ^ b ^ c;
    carry = (((a & b) | ((a ^ b) & c)) << 1) | Width'(from_1);
    positive = {from_2, from_1 ^ from_2};
    negative = {~from_minus_1, from_minus_1 ^ from_0};
  endtask

  if (Pipelined) begin : gen_registers
    always_ff @(posedge clk_i) begin
      if (enable_i) begin : load
        logic [Width-1:0] sum, carry;
        logic [1:0] positive, negative;
        divide(estimate, sum_i << 2, carry_i << 2, divisor_i, sum, carry, positive, negative);
        sum_o <= sum;
        carry_o <= carry;
        divisor_o <= divisor_i;
        positives_o <= {positives_i, positive};
        negatives_o <= {negatives_i, negative};
        beside_o <= beside_i;
      end
    end
  end else begin : gen_wires
    logic [1:0] positive, negative;
    logic unused_clock;

    assign unused_clock = clk_i & enable_i;
    always_comb begin
      divide(estimate, sum_i << 2, carry_i << 2, divisor_i, sum_o, carry_o, positive, negative);
    end
    assign divisor_o = divisor_i;
    assign positives_o = {positives_i, positive};
    assign negatives_o = {negatives_i, negative};
    assign beside_o = beside_i;
  end

endmodule
