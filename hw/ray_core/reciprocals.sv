// Reciprocals of a vector's three words, 1 / word, binary32, rounded to nearest; x lowest.
// Clocks = 1: three dividers, a vector a clock; latency hit_test_pkg::divide_latency. Else a vector in Clocks clocks, and
// fp_vector_divider, for which word and one take turns; latency at most 5 clocks more.
module reciprocals #(
  parameter int unsigned Clocks = 1,
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded
) (
  input  logic        clk_i,
  input  logic        rst_ni,
  input  logic        valid_i,
  output logic        ready_o,
  input  logic [95:0] vector_i,
  output logic        valid_o,
  output logic [95:0] inverse_o
);

  localparam logic [31:0] One = 32'h3f80_0000;

  if (Clocks != 1 && Clocks < 7) begin : gen_check
    $error("reciprocals: expected 1 Clocks, or 7 or more");
  end

  if (Clocks == 1) begin : gen_dividers
    localparam int unsigned Latency = hit_test_pkg::divide_latency(23);
    logic [Latency-1:0] dividing_q;

    assign ready_o = 1'b1;
    assign valid_o = dividing_q[Latency-1];

    for (genvar k = 0; k < 3; k++) begin : gen_word
      fp_pkg::flags_t unused_flags;

      fp_divider_stages #(
        .Arith(Arith),
        .Adder(Adder),
        .PipeRegs(hit_test_pkg::DividerPipeRegs)
      ) u_divider (
        .clk_i,
        .valid_i,
        .a_i(One),
        .b_i(vector_i[32*k +: 32]),
        .rounding_mode_i(fp_pkg::RoundNearestEven),
        .tininess_after_i(1'b0),
        .result_o(inverse_o[32*k +: 32]),
        .flags_o(unused_flags)
      );
    end

    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) dividing_q <= '0;
      else dividing_q <= {dividing_q[Latency-2:0], valid_i};
    end
  end else begin : gen_turns
    logic [Clocks-2:0] since_q;  // clocks since a vector was taken
    logic [6*32-1:0] words_q;
    logic [31:0] quotient;
    logic [2:0] turn_q;  // whose quotient comes next
    logic divided;

    assign ready_o = since_q == '0;

    fp_vector_divider #(
      .Arith(Arith),
      .Adder(Adder),
      .Components(3),
      .Period(Clocks),
      .RowsPerClock(1)
    ) u_divider (
      .clk_i,
      .rst_ni,
      .divisor_i(since_q[0] | since_q[2] | since_q[4]),
      .dividend_i(since_q[1] | since_q[3] | since_q[5]),
      .word_i(words_q[31:0]),
      .rounding_mode_i(fp_pkg::RoundNearestEven),
      .valid_o(divided),
      .result_o(quotient)
    );

    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) begin
        since_q <= '0;
        turn_q  <= 3'd1;
        valid_o <= 1'b0;
      end else begin
        since_q <= {since_q[Clocks-3:0], valid_i & ready_o};
        valid_o <= divided & turn_q[2];
        if (divided) turn_q <= {turn_q[1:0], turn_q[2]};
      end
    end
    always_ff @(posedge clk_i) begin
      words_q <= (valid_i & ready_o)
          ? {One, vector_i[95:64], One, vector_i[63:32], One, vector_i[31:0]} : words_q >> 32;
      if (divided) inverse_o <= {quotient, inverse_o[95:32]};
    end
  end

endmodule
