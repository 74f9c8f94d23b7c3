// Control of a hit-test unit: a counter of the words that come in, and one of the steps that follow.
//
// word_o is the index of the word that the next clock edge takes from the bus. At 0 the unit waits
// until valid_i says that the first word is there; the others follow in consecutive clocks. step_o
// counts 1 to NumSteps in the clocks after the last word, while the next test's first words may
// already be coming in, and is 0 otherwise.
//
// Throughput: a test every NumWords clocks. Latency: first word to last step, NumWords + NumSteps.
// Source: the paper's figures 4 and 9, where a counter drives enables and selects.
module hit_test_control #(
  parameter int unsigned NumWords = 7,
  parameter int unsigned NumSteps = 3,  // two tests' steps never meet
  localparam int unsigned WordWidth = $clog2(NumWords),
  localparam int unsigned StepWidth = $clog2(NumSteps + 1)
) (
  input  logic                 clk_i,
  input  logic                 rst_ni,
  input  logic                 valid_i,  // the first word of a test is on the bus
  output logic                 ready_o,  // it would be taken
  output logic [WordWidth-1:0] word_o,
  output logic [StepWidth-1:0] step_o
);

  if (NumSteps >= NumWords) begin : gen_check
    $error("hit_test_control: expected NumSteps below NumWords");
  end

  localparam logic [WordWidth-1:0] LastWord = WordWidth'(NumWords - 1);
  localparam logic [StepWidth-1:0] LastStep = StepWidth'(NumSteps);

  logic [WordWidth-1:0] word_q, word_d;
  logic [StepWidth-1:0] step_q, step_d;

  assign ready_o = word_q == '0;
  assign word_o = word_q;
  assign step_o = step_q;

  always_comb begin
    word_d = word_q;
    if (word_q == LastWord) begin
      word_d = '0;
    end else if (!ready_o || valid_i) begin
      word_d = word_q + 1'b1;
    end

    step_d = step_q;
    if (word_q == LastWord) begin
      step_d = StepWidth'(1);
    end else if (step_q == LastStep) begin
      step_d = '0;
    end else if (step_q != '0) begin
      step_d = step_q + 1'b1;
    end
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      word_q <= '0;
      step_q <= '0;
    end else begin
      word_q <= word_d;
      step_q <= step_d;
    end
  end

endmodule
