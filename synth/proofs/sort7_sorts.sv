// The sorting network puts any seven words in order and loses none: each word is as often among what comes out as
// among what went in, a clock earlier.
module sort7_sorts #(
  localparam int unsigned Width = 4
) (
  input logic               clk,
  input logic [7*Width-1:0] words,
  input logic [Width-1:0]   word  // any one of them, or none
);

  logic [7*Width-1:0] sorted, words_q;
  logic [Width-1:0] word_q;
  logic full;  // a clock has gone by
  initial full = 1'b0;
  always_ff @(posedge clk) begin
    full <= 1'b1;
    words_q <= words;
    word_q <= word;
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
