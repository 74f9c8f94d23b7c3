// The cache of lines, whatever is asked for and in whichever order memory answers, from reset and for ever: a request
// that is wanted and taken is answered once, with its ray, by the line of its number in memory; it waits in the queue of hits, or is
// enlisted for a place whose line is on its way, and that line does not go before it is answered. No line is asked for
// while it is here or on its way.
// opened_line_cache is line_cache of two sets and two waiters with its registers and memories as outputs. Of memory is said
// what the line `number` holds; which one that is, is free.
module cache_answers_once #(
  localparam int unsigned Lines = 16,
  localparam int unsigned Ways  = 8,
  localparam int unsigned Width = 2,
  localparam int unsigned Depth = 16,  // of the queue of hits
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth,
  localparam int unsigned LabelWidth = AddressWidth - 1
) (
  input logic             clk,
  input logic             invalidate,
  input logic             valid,
  input logic             wanted,
  input logic             ray,
  input logic             miss_ready,
  input logic             fill,
  input logic [3:0]       fill_place,
  input logic [Width-1:0] fill_line,
  input logic             ready,
  input logic             choose  // the request taken now is the one that is watched
);

  logic reset_n;  // low for the first clock
  initial reset_n = 1'b0;
  always_ff @(posedge clk) reset_n <= 1'b1;

  (* anyseq *) logic [AddressWidth-1:0] line_number;
  (* anyconst *) logic [AddressWidth-1:0] number;  // of a line, and what it holds
  (* anyconst *) logic [Width-1:0] content;

  logic taken, miss, fill_done, answer, answer_ray;
  logic [3:0] miss_place;
  logic [AddressWidth-1:0] miss_number;
  logic [Width-1:0] answer_line;
  logic [Lines-1:0] held, pending;
  logic [1:0] free, follows, nexts, rays;
  logic draining, draining_waiter, waiter, current, somebody, leaves, room, queued;
  logic [3:0] place, read_q, write_q;
  logic [4:0] count;
  logic [Lines*Width-1:0] words;
  logic [Lines*LabelWidth-1:0] labels;
  logic [Lines*2-1:0] heads;
  logic [Depth*(1+Width)-1:0] queue;

  opened_line_cache dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .invalidate_i(invalidate),
    .valid_i(valid),
    .ready_o(taken),
    .wanted_i(wanted),
    .ray_i(ray),
    .line_number_i(line_number),
    .miss_valid_o(miss),
    .miss_ready_i(miss_ready),
    .miss_place_o(miss_place),
    .miss_number_o(miss_number),
    .fill_i(fill),
    .fill_done_o(fill_done),
    .fill_place_i(fill_place),
    .fill_line_i(fill_line),
    .valid_o(answer),
    .ready_i(ready),
    .ray_o(answer_ray),
    .line_o(answer_line),
    .held_q(held),
    .pending_q(pending),
    .free_q(free),
    .follows_q(follows),
    .draining_q(draining),
    .current_q(draining_waiter),
    .waiter(waiter),
    .current(current),
    .somebody(somebody),
    .leaves(leaves),
    .place(place),
    .room(room),
    .\u_hits.count_q (count),
    .\u_hits.valid_o (queued),
    .\u_hits.read_q (read_q),
    .\u_hits.write_q (write_q),
    .words(words),
    .labels(labels),
    .heads(heads),
    .nexts(nexts),
    .rays(rays),
    .u_hits_words(queue)
  );

  logic request, asked, enlists, hits;  // this clock's
  assign request = valid && taken && wanted;
  assign asked   = miss && miss_ready;
  assign hits    = held[place] && labels[LabelWidth*place+:LabelWidth] == line_number[AddressWidth-1:1];
  assign enlists = request && !hits;

  // ---- Which places wait for the line `number`; whether the line that comes is that one

  logic [Lines-1:0] is_number;
  logic came_q, comes;  // of the line that is being given away, and of this clock's
  assign comes = draining ? came_q : is_number[fill_place];

  always_ff @(posedge clk) begin
    if (asked) is_number[miss_place] <= miss_number == number;
    came_q <= comes;
  end

  // ---- What the user promises

  logic [3:0] place_q;  // of the line that is being given away
  always_ff @(posedge clk) place_q <= (fill && !draining) ? fill_place : place_q;
  always_comb begin
    if (reset_n) begin
      assume (!fill || (ready && (draining ? fill_place == place_q : pending[fill_place])));
      assume (!fill || !comes || fill_line == content);
      assume (!invalidate || (pending == '0 && !draining));
    end else begin
      assume (!fill && !invalidate && !valid && !ready);
    end
  end

  // ---- The waiters: for which place each is enlisted, and whether its line has come and is being given away

  logic [3:0] place_0, place_1;
  always_ff @(posedge clk) begin
    if (enlists && !waiter) place_0 <= place;
    if (enlists && waiter) place_1 <= place;
  end
  logic [1:0] coming;  // its line is being given away: it is no longer in its place's list
  assign coming = {draining && draining_waiter, draining && !draining_waiter};

  // ---- The watched request

  localparam logic [1:0] Nowhere = 2'd0, Queued = 2'd1, Enlisted = 2'd2;
  logic [1:0] state;
  logic w_ray, w_waiter, answered;
  logic [3:0] w_index, w_place;
  logic [4:0] ahead, outstanding;
  initial state = Nowhere;

  assign w_place  = w_waiter ? place_1 : place_0;
  assign answered = state == Queued ? leaves && ahead == '0 : fill && somebody && current == w_waiter;

  always_ff @(posedge clk) begin
    if (!reset_n) begin
      state <= Nowhere;
      outstanding <= '0;
    end else begin
      outstanding <= outstanding + 5'(request) - 5'(answer);
      if (state == Nowhere) begin
        if (request && choose && line_number == number) begin
          state <= hits ? Queued : Enlisted;
          w_ray <= ray;
          w_waiter <= waiter;
          w_index <= write_q;
          ahead <= count - 5'(leaves);
        end
      end else if (answered) begin
        state <= Nowhere;
      end else if (leaves) begin
        ahead <= ahead - 1'b1;
      end
    end
  end

  // ---- Claims

  always_comb begin
    if (reset_n) begin
      if (state != Nowhere && answered) assert (answer && answer_ray == w_ray && answer_line == content);
      if (answer) assert (outstanding != '0 && ready);
      assert (outstanding == count + 5'(!free[0]) + 5'(!free[1]));
      // Its line does not go without it
      if (state == Enlisted && fill_done && fill_place == w_place
          && (draining ? coming[w_waiter] : !coming[w_waiter])) assert (answered);
      if (state == Enlisted) assert (pending[w_place] || coming[w_waiter]);
      if (asked) begin
        assert (!pending[miss_place] && miss_number == line_number && miss_place[3] == line_number[0]);
      end
      for (int unsigned p = 0; p < Lines; p++) begin
        if (asked && (held[p] || pending[p]) && (p >= Ways) == line_number[0]) begin
          assert (labels[LabelWidth*p+:LabelWidth] != line_number[AddressWidth-1:1]);
        end
      end

      assert (state != 2'd3);

      // Invariants: a line is in one place, that of `number` is its content
      assert ((held & pending) == '0);
      for (int unsigned p = 0; p < Lines; p++) begin
        for (int unsigned q = p + 1; q < (p < Ways ? Ways : Lines); q++) begin
          if ((held[p] || pending[p]) && (held[q] || pending[q])) begin
            assert (labels[LabelWidth*p+:LabelWidth] != labels[LabelWidth*q+:LabelWidth]);
          end
        end
        if (held[p] && labels[LabelWidth*p+:LabelWidth] == number[AddressWidth-1:1] && (p >= Ways) == number[0]) begin
          assert (words[Width*p+:Width] == content);
        end
        if (pending[p]) begin
          assert (is_number[p] == (labels[LabelWidth*p+:LabelWidth] == number[AddressWidth-1:1]
                                   && (p >= Ways) == number[0]));
          // The list of a place that waits: who enlisted last, and before
          assert (heads[2*p+1] == ((!free[0] && !coming[0] && place_0 == 4'(p))
                                   || (!free[1] && !coming[1] && place_1 == 4'(p))));
          if (heads[2*p+1]) begin
            assert (!free[heads[2*p]] && !coming[heads[2*p]] && (heads[2*p] ? place_1 : place_0) == 4'(p));
            assert (follows[heads[2*p]] == (!free[!heads[2*p]] && !coming[!heads[2*p]]
                                            && (heads[2*p] ? place_0 : place_1) == 4'(p)));
            if (follows[heads[2*p]]) assert (nexts[heads[2*p]] == !heads[2*p] && !follows[!heads[2*p]]);
          end
        end
      end
      if (!free[0]) assert (pending[place_0] || coming[0]);
      if (!free[1]) assert (pending[place_1] || coming[1]);
      if (draining) begin
        assert (!free[draining_waiter] && !follows[draining_waiter]
                && (draining_waiter ? place_1 : place_0) == place_q);
      end
      // The queue of hits
      assert (count <= 5'(Depth) && queued == (count != '0) && room == (count < 5'(Depth)) && write_q == read_q + count[3:0]);
      if (state == Queued) begin
        assert (ahead < count && w_index == read_q + ahead[3:0]);
        assert (queue[(1+Width)*w_index+:1+Width] == {w_ray, content});
      end
      if (state == Enlisted) begin
        assert (!free[w_waiter] && rays[w_waiter] == w_ray);
        if (coming[w_waiter]) assert (came_q);
        else assert (is_number[w_place]);
      end

      cover (state == Queued && answered && count > 5'd2);
      cover (state == Enlisted && draining && answered);
      cover (state == Enlisted && !draining && answered && fill_done);
      cover (asked && held[miss_place]);
    end
  end

endmodule
