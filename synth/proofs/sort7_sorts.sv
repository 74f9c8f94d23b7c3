// Claims: the sorting network sorts any seven words in ascending order, and loses none: each value occurs in the output
// as often as in the input two clocks before.
module sort7_sorts #(
  localparam int unsigned Width = 4
) (
  input logic               clk,
  input logic [7*Width-1:0] words,
  input logic [Width-1:0]   word  // an arbitrary value, whose occurrences are counted
);

  logic [7*Width-1:0] sorted, words_1, words_q;
  logic [Width-1:0] word_1, word_q;
  logic begun, full;  // full: at least two clocks have passed
  initial {begun, full} = 2'b00;
  always_ff @(posedge clk) begin
    {begun, full} <= {1'b1, begun};
    {words_1, words_q} <= {words, words_1};
    {word_1, word_q} <= {word, word_1};
  end

  sort7 #(
    .Width(Width)
  ) dut (
    .clk_i(clk),
    .words_i(words),
    .sorted_o(sorted)
  );

  function automatic logic [2:0] number(logic [7*Width-1:0] among, logic [Width-1:0] of);
    number = '0;
    for (int unsigned n = 0; n < 7; n++) number = number + 3'(among[Width*n+:Width] == of);
  endfunction

  always_comb begin
    if (full) begin
      for (int unsigned n = 0; n < 6; n++) begin
        assert (sorted[Width*n+:Width] <= sorted[Width*(n+1)+:Width]);
      end
      assert (number(sorted, word_q) == number(words_q, word_q));
    end
  end

endmodule
