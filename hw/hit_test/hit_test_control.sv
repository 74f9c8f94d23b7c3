// Control of a hit-test unit: counts words, then steps.
//
// word_o is the index of the word that the next clock edge takes from the bus. At 0 the unit waits for valid_i; the
// other words follow in consecutive clocks. step_o counts 1 to NumSteps in the clocks after the last word, while the
// next test's first words may already come in, and is 0 otherwise.
//
// Throughput: a test every NumWords clocks. Latency: NumWords + NumSteps clocks (first word to last step).
// Source: the paper's figures 4 and 9, where a counter drives enables and selects.
module hit_test_control #(
  parameter int unsigned NumWords = 7,
  parameter int unsigned NumSteps = 3,  // fewer than NumWords: steps of two tests never overlap
  localparam int unsigned WordWidth = $clog2(NumWords),
  localparam int unsigned StepWidth = $clog2(NumSteps + 1)
) (
  input  logic                 clk_i,
  input  logic                 rst_ni,
  input  logic                 valid_i,  // the first word of a test is on the bus
  output logic                 ready_o,  // a first word would be taken
  output logic [WordWidth-1:0] word_o,
  output logic [StepWidth-1:0] step_o
);

  if (NumSteps >= NumWords) begin : gen_check
    $error("hit_test_control: expected NumSteps below NumWords");
  end

  localparam logic [WordWidth-1:0] LastWord = WordWidth'(NumWords - 1);
  localparam logic [StepWidth-1:0] LastStep = StepWidth'(NumSteps);

  logic [WordWidth-1:0] word_d;
  logic [StepWidth-1:0] step_d;

  assign ready_o = word_o == '0;

  always_comb begin
    word_d = word_o;
    if (word_o == LastWord) word_d = '0;
    else if (!ready_o || valid_i) word_d = word_o + 1'b1;

    step_d = step_o;
    if (word_o == LastWord) step_d = StepWidth'(1);
    else if (step_o == LastStep) step_d = '0;
    else if (step_o != '0) step_d = step_o + 1'b1;
  end

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      word_o <= '0;
      step_o <= '0;
    end else begin
      word_o <= word_d;
      step_o <= step_d;
    end
  end

endmodule
