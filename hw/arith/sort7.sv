// Sorts seven unsigned words, the smallest lowest: 16 comparators in six steps.
// Latency: 2 clocks: registers after the second and the fourth step.
// Source: Batcher's network for eight words, with one word left out.
module sort7 #(
  parameter int unsigned Width = 27
) (
  input  logic               clk_i,
  input  logic [7*Width-1:0] words_i,
  output logic [7*Width-1:0] sorted_o
);

  // In each step, octal digit n is the index of the word that word n is compared with (n: none). Top: step 5, word 6.
  localparam logic [6*21-1:0] Partners = {
    21'o5634120, 21'o6452310, 21'o4563120, 21'o6234501, 21'o3516042, 21'o0452316
  };

  for (genvar s = 0; s < 6; s++) begin : gen_step
    logic [7*Width-1:0] unsorted, ordered;

    for (genvar n = 0; n < 7; n++) begin : gen_word
      localparam int unsigned Partner = 32'(Partners[21*s+3*n+:3]);
      if (Partner > n) begin : gen_pair
        logic less;
        logic [Width-1:0] low, high;
        assign low  = unsorted[Width*n +: Width];
        assign high = unsorted[Width*Partner +: Width];
        assign less = high < low;
        assign ordered[Width*n +: Width]       = less ? high : low;
        assign ordered[Width*Partner +: Width] = less ? low : high;
      end else if (Partner == n) begin : gen_rest
        assign ordered[Width*n+:Width] = unsorted[Width*n+:Width];
      end
    end
  end

  assign gen_step[0].unsorted = words_i;
  assign gen_step[1].unsorted = gen_step[0].ordered;
  assign gen_step[3].unsorted = gen_step[2].ordered;
  assign gen_step[5].unsorted = gen_step[4].ordered;
  assign sorted_o = gen_step[5].ordered;

  always_ff @(posedge clk_i) begin
    gen_step[2].unsorted <= gen_step[1].ordered;
    gen_step[4].unsorted <= gen_step[3].ordered;
  end

endmodule
