// Divides significands like srt_divider, in a few rows that are used again in each clock.
//
// A division begins with start_i: what srt_first_row made of it, its divisor, and side_i, which comes out with it. Its other
// Rows digits are found RowsPerClock at a time. Latency: Rows / RowsPerClock + 1 clocks, until done_o; for that clock the
// outputs are what srt_quotient takes. Throughput: one division in Period clocks; what takes more than Period - 1 clocks
// goes through several stages of RowsPerClock rows, of which each makes Period steps.
// Source: as srt_divider.
module srt_divider_iterative #(
  parameter int unsigned Width = 25,  // of the residual, see srt_row
  parameter int unsigned Rows = 12,
  parameter int unsigned RowsPerClock = 2,
  parameter int unsigned Period = 7,
  parameter int unsigned SideWidth = 1,
  parameter int unsigned Arith = arith_pkg::Graded
) (
  input  logic                 clk_i,
  input  logic                 rst_ni,
  input  logic                 start_i,
  input  logic [Width-1:0]     sum_i,
  input  logic [Width-1:0]     carry_i,
  input  logic [1:0]           digit_i,
  input  logic [Width-1:0]     divisor_i,
  input  logic [SideWidth-1:0] side_i,
  output logic                 done_o,
  output logic [Width-1:0]     sum_o,
  output logic [Width-1:0]     carry_o,
  output logic [2*Rows+1:0]    positives_o,
  output logic [2*Rows+1:0]    negatives_o,
  output logic [SideWidth-1:0] side_o
);

  localparam int unsigned Steps = Rows / RowsPerClock;
  localparam int unsigned Stages = (Steps + Period) / Period;

  if (Steps * RowsPerClock != Rows) begin : gen_check
    $error("srt_divider_iterative: expected Rows that RowsPerClock divides");
  end

  // ---- What has begun, by the clocks since

  logic [Steps:0] begun_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begun_q <= '0;
    else begun_q <= {begun_q[Steps-1:0], start_i};
  end
  assign done_o = begun_q[Steps];

  // ---- Stages: a register, and rows from it to itself; the last step of a stage leads to the next one

  for (genvar s = 0; s < Stages; s++) begin : gen_stage
    // Digits that its register holds in the end; two bits each
    localparam int unsigned LastStep = (s == Stages - 1) ? Steps : Period * (s + 1) - 1;
    localparam int unsigned DigitsWidth = 2 * (1 + RowsPerClock * LastStep);
    logic load;
    logic [Width-1:0] sum_q, carry_q, divisor_q, first_sum, first_carry, first_divisor;
    logic [DigitsWidth-1:0] positives_q, negatives_q, first_positives, first_negatives;
    logic [2*RowsPerClock-1:0] positives, negatives;  // found in this clock
    logic [SideWidth-1:0] side_q, first_side;

    if (s == 0) begin : gen_first
      assign load = start_i;
      assign {first_sum, first_carry} = {sum_i, carry_i};
      assign {first_divisor, first_side} = {divisor_i, side_i};
      assign first_positives = DigitsWidth'(digit_i);
      assign first_negatives = '0;
    end else begin : gen_next
      assign load = begun_q[Period*s-1];
      assign first_sum = gen_stage[s-1].gen_row[RowsPerClock].sum;
      assign first_carry = gen_stage[s-1].gen_row[RowsPerClock].carry;
      assign first_divisor = gen_stage[s-1].divisor_q;
      assign first_side = gen_stage[s-1].side_q;
      assign first_positives = DigitsWidth'({gen_stage[s-1].positives_q, gen_stage[s-1].positives});
      assign first_negatives = DigitsWidth'({gen_stage[s-1].negatives_q, gen_stage[s-1].negatives});
    end

    for (genvar r = 0; r <= RowsPerClock; r++) begin : gen_row
      logic [Width-1:0] sum, carry;

      if (r == 0) begin : gen_register
        assign {sum, carry} = {sum_q, carry_q};
      end else begin : gen_srt
        srt_row #(
          .Width(Width),
          .Arith(Arith)
        ) u_row (
          .sum_i(gen_row[r-1].sum),
          .carry_i(gen_row[r-1].carry),
          .divisor_i(divisor_q),
          .sum_o(sum),
          .carry_o(carry),
          .positive_o(positives[2*(RowsPerClock-r)+:2]),
          .negative_o(negatives[2*(RowsPerClock-r)+:2])
        );
      end
    end

    always_ff @(posedge clk_i) begin
      sum_q <= load ? first_sum : gen_row[RowsPerClock].sum;
      carry_q <= load ? first_carry : gen_row[RowsPerClock].carry;
      positives_q <= load ? first_positives : DigitsWidth'({positives_q, positives});
      negatives_q <= load ? first_negatives : DigitsWidth'({negatives_q, negatives});
      if (load) {divisor_q, side_q} <= {first_divisor, first_side};
    end
  end

  assign sum_o = gen_stage[Stages-1].sum_q;
  assign carry_o = gen_stage[Stages-1].carry_q;
  assign positives_o = gen_stage[Stages-1].positives_q;
  assign negatives_o = gen_stage[Stages-1].negatives_q;
  assign side_o = gen_stage[Stages-1].side_q;

endmodule
