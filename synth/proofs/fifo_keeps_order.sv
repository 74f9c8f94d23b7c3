// Claims, from reset on, for any allowed pushes and pops: The FIFO returns each word once, in order. With Memory, a
// word leaves at the earliest in the second clock after its push. The FIFO never holds more than Depth words. valid_o:
// there is a word at the output. space_o: more than Reserve places are free. A valid output word holds until it is
// popped. opened_fifo is the FIFO with its registers as outputs, for the induction.
module fifo_keeps_order #(
  parameter int unsigned Depth   = 5,
  parameter int unsigned Reserve = 2,
  parameter bit          Memory  = 1'b0,
  localparam int unsigned Width      = 2,
  localparam int unsigned IndexWidth = $clog2(Depth),
  localparam int unsigned CountWidth = $clog2(Depth + 1)
) (
  input logic             clk,
  input logic             push,
  input logic             pop,
  input logic [Width-1:0] data,
  input logic             choose  // watch the word pushed now
);

  logic reset_n;  // low for the first clock
  initial reset_n = 1'b0;
  always_ff @(posedge clk) reset_n <= 1'b1;

  logic space, valid;
  logic [Width-1:0] word;
  logic [IndexWidth-1:0] write_q, read_q;
  logic [CountWidth-1:0] count_q;
  logic [Depth*Width-1:0] words;

  opened_fifo dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .push_i(push),
    .data_i(data),
    .space_o(space),
    .pop_i(pop),
    .valid_o(valid),
    .data_o(word),
    .write_q(write_q),
    .read_q(read_q),
    .count_q(count_q),
    .words(words)
  );

  localparam logic [CountWidth-1:0] Full = CountWidth'(Depth);

  logic late;  // the last word was pushed in the previous clock, and is not at the memory's output yet
  logic [CountWidth-1:0] count;  // words pushed and not popped
  always_ff @(posedge clk) begin
    late <= Memory && reset_n && push;
    count <= reset_n ? count + CountWidth'(push) - CountWidth'(pop) : '0;
  end

  always_comb begin
    if (reset_n) assume ((!push || count < Full) && (!pop || valid));
    else assume (!push && !pop);
  end

  // The watched word: its value, its address, and the number of words to be popped before it
  logic watching;
  logic [Width-1:0] watched;
  logic [IndexWidth-1:0] place;
  logic [CountWidth-1:0] ahead;
  initial watching = 1'b0;
  always_ff @(posedge clk) begin
    if (!reset_n) begin
      watching <= 1'b0;
    end else if (!watching && push && choose) begin
      watching <= 1'b1;
      watched <= data;
      place <= write_q;
      ahead <= count - CountWidth'(pop);
    end else if (watching && pop) begin
      watching <= ahead != '0;
      ahead <= ahead - 1'b1;
    end
  end

  logic waiting;
  logic [Width-1:0] word_before;
  initial waiting = 1'b0;
  always_ff @(posedge clk) begin
    waiting <= reset_n && valid && !pop;
    word_before <= word;
  end

  // Addresses without wrapping at Depth. A word at a memory's output is no longer counted as stored
  logic at_output;
  logic [CountWidth:0] write_unwrapped, place_unwrapped;
  assign at_output = Memory && valid;
  assign write_unwrapped = (CountWidth + 1)'(read_q) + (CountWidth + 1)'(count) - (CountWidth + 1)'(at_output);
  assign place_unwrapped = (CountWidth + 1)'(read_q) + (CountWidth + 1)'(ahead) - (CountWidth + 1)'(at_output);

  always_comb begin
    if (reset_n) begin
      assert (valid == (count != CountWidth'(late)));
      assert (space == (count < CountWidth'(Depth - Reserve)));
      if (waiting) assert (valid && word == word_before);
      if (watching && ahead == '0 && valid) assert (word == watched);

      // Invariants
      assert (count <= Full && count_q == count);
      assert (read_q < Depth && write_q < Depth);
      assert (write_unwrapped
              == (CountWidth + 1)'(write_q) + (write_q < read_q || (!Memory && count == Full) ? Depth : 0));
      if (watching) begin
        assert (ahead < count && place < Depth);
        if (ahead != '0 || !at_output) begin
          assert (place_unwrapped == (CountWidth + 1)'(place) + (place < read_q ? Depth : 0));
          assert (words[Width*place+:Width] == watched);
        end
      end

      cover (!space && pop);
      cover (waiting && watching && ahead == '0 && watched == '1);
      cover (watching && place == IndexWidth'(Depth - 1));
    end
  end

endmodule
