// Claims, from reset on, for any requests and any order of memory's answers: line_cache looks up and answers each
// demand request once. The answer has the request's ray, and the line of the requested number or an error. Until the
// answer, the request is in the queue of hits, or is a target of an entry with a pending line; that line stays in the
// entry until the answer. A line that is cached or pending is not requested from memory. opened_line_cache is
// line_cache of two sets and two targets, with registers and memories as outputs. One line, any `number`, is modelled.
module cache_answers_once #(
  localparam int unsigned Lines = 16,
  localparam int unsigned Ways  = 8,
  localparam int unsigned Width = 2,
  localparam int unsigned Depth = 16,  // depth of the queue of hits
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth,
  localparam int unsigned TagWidth = AddressWidth - 1
) (
  input logic             clk,
  input logic             invalidate,
  input logic             valid,
  input logic             demand,
  input logic             ray,
  input logic             miss_ready,
  input logic             fill,
  input logic [3:0]       fill_entry,
  input logic [Width-1:0] fill_line,
  input logic             fill_error,
  input logic             ready,
  input logic             choose  // watch the request taken now
);

  logic reset_n;  // low for the first clock
  initial reset_n = 1'b0;
  always_ff @(posedge clk) reset_n <= 1'b1;

  (* anyseq *) logic [AddressWidth-1:0] line_number;
  (* anyconst *) logic [AddressWidth-1:0] number;  // of the modelled line; `content` is the line's content
  (* anyconst *) logic [Width-1:0] content;

  logic taken, request_q, demand_q, ray_q, done, set, hit_q, hit_ray, looking;
  logic compare_q, compare_demand_q, compare_ray, compare_set, changed;
  logic [2:0] changed_way;
  logic [Ways-1:0] same, valid_ways, pending_ways;
  logic [TagWidth-1:0] tag, compare_tag, changed_tag;
  logic [Ways*TagWidth-1:0] set_tags;
  logic [Width-1:0] hit_line;
  logic miss, fill_ready, answer, answer_ray, answer_error, error;
  logic [3:0] miss_entry;
  logic [AddressWidth-1:0] miss_number;
  logic [Width-1:0] answer_line, line;  // `line`: the line from memory that is being passed to its targets
  logic [Lines-1:0] line_valid, pending, mores;
  logic [1:0] free, rays;
  logic [3:0] nexts;
  logic draining, draining_more, draining_target, give, target, leaves, room, queued;
  logic [3:0] entry, read_q, write_q;
  logic [4:0] count;
  logic [Lines*Width-1:0] words;
  logic [Lines*TagWidth-1:0] tag_words, tags;  // tag_words: by set and way; tags: by entry
  logic [Lines*2-1:0] heads;
  logic [Depth*(1+Width)-1:0] queue;
  logic [Width:0] queued_word;

  opened_line_cache dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .invalidate_i(invalidate),
    .valid_i(valid),
    .ready_o(taken),
    .demand_i(demand),
    .ray_i(ray),
    .line_number_i(line_number),
    .outstanding_o(looking),
    .miss_valid_o(miss),
    .miss_ready_i(miss_ready),
    .miss_entry_o(miss_entry),
    .miss_number_o(miss_number),
    .fill_i(fill),
    .fill_ready_o(fill_ready),
    .fill_entry_i(fill_entry),
    .fill_line_i(fill_line),
    .fill_error_i(fill_error),
    .valid_o(answer),
    .ready_i(ready),
    .ray_o(answer_ray),
    .line_o(answer_line),
    .error_o(answer_error),
    .valid_q(line_valid),
    .pending_q(pending),
    .free_q(free),
    .mores_q(mores),
    .draining_q(draining),
    .more_q(draining_more),
    .current_q(draining_target),
    .give(give),
    .line_q(line),
    .error_q(error),
    .target(target),
    .leaves(leaves),
    .entry(entry),
    .room(room),
    .\u_hits.count_q (count),
    .\u_hits.valid_o (queued),
    .\u_hits.data_o (queued_word),
    .\u_hits.read_q (read_q),
    .\u_hits.write_q (write_q),
    .request_q(request_q),
    .demand_q(demand_q),
    .ray_q(ray_q),
    .set(set),
    .tag(tag),
    .set_tags(set_tags),
    .compare_q(compare_q),
    .compare_demand_q(compare_demand_q),
    .compare_ray_q(compare_ray),
    .compare_tag_q(compare_tag),
    .compare_set_q(compare_set),
    .changed_q(changed),
    .changed_way_q(changed_way),
    .changed_tag_q(changed_tag),
    .same_q(same),
    .valid_ways_q(valid_ways),
    .pending_ways_q(pending_ways),
    .done(done),
    .hit_q(hit_q),
    .hit_ray_q(hit_ray),
    .hit_line(hit_line),
    .u_lines_words(words),
    .u_tags_words(tag_words),
    .heads(heads),
    .nexts(nexts),
    .rays(rays),
    .u_hits_words(queue)
  );

  for (genvar p = 0; p < Lines; p++) begin : gen_tag
    assign tags[TagWidth*p+:TagWidth] = tag_words[TagWidth*(Ways*(p%2)+p/2)+:TagWidth];
  end

  logic [AddressWidth-1:0] looked_up;
  logic request, asked, adds_target, hits;  // events of this clock. request: the look-up of a demand request ends
  assign looked_up   = {tag, set};
  assign request     = request_q && done && demand_q;
  assign asked       = miss && miss_ready;
  assign hits        = line_valid[entry] && tags[TagWidth*entry+:TagWidth] == tag;
  assign adds_target = request && !hits;

  // ---- Which entries wait for line `number`, and whether the line being passed to its targets is line `number`

  logic [Lines-1:0] is_number;
  logic came_q;  // the line being passed on is line `number`
  logic [3:0] entry_q;  // entry of the line being passed on

  always_ff @(posedge clk) begin
    if (asked) is_number[miss_entry] <= miss_number == number;
    if (fill_ready) {came_q, entry_q} <= {is_number[fill_entry], fill_entry};
  end

  // ---- Assumptions about the user

  always_comb begin
    if (reset_n) begin
      assume (!fill || pending[fill_entry]);
      assume (!fill || !is_number[fill_entry] || fill_error || fill_line == content);
      assume (!invalidate || (pending == '0 && !draining && !request_q && !compare_q));
    end else begin
      assume (!fill && !invalidate && !valid && !ready);
    end
  end

  // ---- The targets: the entry that each target waits for, and whether the entry's line is being passed to its targets

  logic [3:0] entry_0, entry_1;
  always_ff @(posedge clk) begin
    if (adds_target && !target) entry_0 <= entry;
    if (adds_target && target) entry_1 <= entry;
  end
  logic [1:0] coming;  // per target: its line is being passed on, and the target is no longer in its entry's list
  assign coming = {2{draining}} & {draining_target || draining_more, !draining_target || draining_more};

  // ---- The watched request

  localparam logic [2:0] Nowhere = 3'd0, Queued = 3'd1, Pending = 3'd2, LookedUp = 3'd3, Compared = 3'd4;
  logic [2:0] state;
  logic w_ray, w_target, answered;
  logic [3:0] w_index, w_entry;
  logic [4:0] ahead, outstanding;
  initial state = Nowhere;

  assign w_entry  = w_target ? entry_1 : entry_0;
  assign answered = state == Queued ? leaves && ahead == '0
                  : state == Pending && give && draining_target == w_target;

  always_ff @(posedge clk) begin
    if (!reset_n) begin
      state <= Nowhere;
      outstanding <= '0;
    end else begin
      outstanding <= outstanding + 5'(valid && taken && demand) - 5'(answer);
      if (state == Nowhere) begin
        if (valid && taken && demand && choose && line_number == number) begin
          state <= Compared;
          w_ray <= ray;
        end
      end else if (state == Compared) begin
        if (!request_q || done) state <= LookedUp;
      end else if (state == LookedUp) begin
        if (request) begin
          state <= hits ? Queued : Pending;
          w_target <= target;
          w_index <= write_q + 4'(hit_q);
          ahead <= count + 5'(hit_q) - 5'(leaves);
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
      if (state != Nowhere && answered) begin
        assert (answer && answer_ray == w_ray);
        assert (answer_error ? state == Pending && error : answer_line == content);
      end
      if (answer) assert (outstanding != '0 && ready);
      assert (outstanding == count + 5'(hit_q) + 5'(request_q && demand_q)
                             + 5'(compare_q && compare_demand_q) + 5'(!free[0]) + 5'(!free[1]));
      // The line of a pending request is not dropped before the request is answered
      if (state == Pending && coming[w_target] && fill_ready) assert (answered);
      if (state == Pending) assert (pending[w_entry] || coming[w_target]);
      if (asked) begin
        assert (!pending[miss_entry] && miss_number == looked_up && miss_entry[0] == set);
      end
      for (int unsigned p = 0; p < Lines; p++) begin
        if (asked && (line_valid[p] || pending[p]) && 1'(p % 2) == set) begin
          assert (tags[TagWidth*p+:TagWidth] != tag);
        end
      end

      // The requests in the stages of comparison and look-up, with the tags of their sets
      for (int unsigned w = 0; w < Ways; w++) begin
        if (compare_q) begin
          assert ((changed && changed_way == 3'(w) ? changed_tag : set_tags[TagWidth*w+:TagWidth])
                  == tag_words[TagWidth*(Ways*compare_set+w)+:TagWidth]);
        end
        if (request_q) begin
          assert (same[w] == (tag_words[TagWidth*(Ways*set+w)+:TagWidth] == tag));
          assert (valid_ways[w] == line_valid[2*w+set] && pending_ways[w] == pending[2*w+set]);
        end
      end
      if (state == Compared) begin
        assert (compare_q && compare_demand_q && {compare_tag, compare_set} == number && compare_ray == w_ray);
      end
      if (state == LookedUp) assert (request_q && demand_q && looked_up == number && ray_q == w_ray);

      // Invariants: a line is in at most one entry; line `number` has the value `content`
      assert ((line_valid & pending) == '0);
      for (int unsigned p = 0; p < Lines; p++) begin
        for (int unsigned q = p + 2; q < Lines; q += 2) begin
          if ((line_valid[p] || pending[p]) && (line_valid[q] || pending[q])) begin
            assert (tags[TagWidth*p+:TagWidth] != tags[TagWidth*q+:TagWidth]);
          end
        end
        if (line_valid[p] && tags[TagWidth*p+:TagWidth] == number[AddressWidth-1:1] && 1'(p % 2) == number[0]) begin
          assert (words[Width*p+:Width] == content);
        end
        if (pending[p]) begin
          assert (is_number[p] == (tags[TagWidth*p+:TagWidth] == number[AddressWidth-1:1]
                                   && 1'(p % 2) == number[0]));
          // A pending entry's list has the targets that wait for the entry's line, the latest first
          assert (heads[2*p+1] == ((!free[0] && !coming[0] && entry_0 == 4'(p))
                                   || (!free[1] && !coming[1] && entry_1 == 4'(p))));
          if (!heads[2*p+1]) assert (!mores[p]);
          else begin
            assert (!free[heads[2*p]] && !coming[heads[2*p]] && (heads[2*p] ? entry_1 : entry_0) == 4'(p));
            assert (mores[p] == (!free[!heads[2*p]] && !coming[!heads[2*p]]
                                     && (heads[2*p] ? entry_0 : entry_1) == 4'(p)));
            if (mores[p]) assert (nexts[2*heads[2*p]+:2] == {1'b0, !heads[2*p]});
          end
        end
      end
      if (!free[0]) assert (pending[entry_0] || coming[0]);
      if (!free[1]) assert (pending[entry_1] || coming[1]);
      if (draining) begin
        if (came_q && !error) assert (line == content);
        assert (!free[draining_target] && (draining_target ? entry_1 : entry_0) == entry_q);
        if (draining_more) begin
          assert (!free[!draining_target] && (draining_target ? entry_0 : entry_1) == entry_q);
          assert (nexts[2*draining_target+:2] == {1'b0, !draining_target});
        end
      end
      // The queue of hits
      assert (count <= 5'(Depth) && room == (count < 5'(Depth - 1)) && write_q == read_q + count[3:0] - 4'(queued));
      assert (!hit_q || count < 5'(Depth));
      if (count > 5'd1) assert (queued);
      if (queued) assert (count != '0);
      if (state == Queued) begin
        if (ahead == count) assert (hit_q && w_index == write_q && {hit_ray, hit_line} == {w_ray, content});
        else if (ahead == '0 && queued) assert (queued_word == {w_ray, content});
        else begin
          assert (ahead < count && w_index == read_q + ahead[3:0] - 4'(queued));
          assert (queue[(1+Width)*w_index+:1+Width] == {w_ray, content});
        end
        assert (ahead <= count);
      end
      if (state == Pending) begin
        assert (!free[w_target] && rays[w_target] == w_ray);
        if (coming[w_target]) assert (came_q);
        else assert (is_number[w_entry]);
      end

      cover (state == Queued && answered && count > 5'd2);
      cover (state == Pending && answered && draining_more);
      cover (state == Pending && answered && fill_ready);
      cover (asked && line_valid[miss_entry]);
    end
  end

endmodule
