// Claims, from reset on, for any results of tests at any time: closest_hit loses no sure hit. A sure hit is kept, or
// has been reported once as a doubt, or its lower bound of t is above t_max. t_max is the minimum of the user's t_max
// and the upper bounds of t of all hits so far. An undecided test is reported once as a doubt. The output P and t are
// those of the kept hit. Tests in flight are counted correctly, and the queue has room for a doubt of each.
// opened_closest_hit is closest_hit for two rays; its registers and memories are outputs. fifo_keeps_order proves that
// its queues keep order.
module hits_keep_nearest #(
  localparam int unsigned Rays     = 2,
  localparam int unsigned Queue    = 18,
  localparam int unsigned TErrorWidth = set_up_pkg::TErrorExponentWidth,
  localparam int unsigned TestsWidth  = ray_core_pkg::TestsWidth
) (
  input logic        clk,
  input logic        load,
  input logic        load_ray,
  input logic [30:0] load_t_max,
  input logic        load_any_hit,
  input logic        test,
  input logic        test_ray,
  input logic        read,  // a result arrives; the unit compares it with the kept hit in the next clock
  input logic        read_ray,
  input logic [31:0] read_triangle,
  input logic        read_skipped,
  input logic        read_doubt,
  input logic        read_hit,
  input logic [31:0] read_t,
  input logic [3:0]  read_t_error,
  input logic [3:0]  read_normal_error,
  input logic [3:0]  read_distance_error,
  input logic [Rays-1:0] failed,
  input logic        traversal_ray,
  input logic        leaf_ray,
  input logic        box_ray,
  input logic        doubt_fire,
  input logic        end_ray,
  input logic        point_ray,
  input logic        choose  // watch the hit that comes now
);

  localparam logic [31:0] Infinity = 32'h7f80_0000;

  logic reset_n;  // low for the first clock
  initial reset_n = 1'b0;
  always_ff @(posedge clk) reset_n <= 1'b1;

  (* anyseq *) logic [95:0] point;
  (* anyseq *) logic [31:0] load_tag;

  logic tests_allowed, traversal_ended, leaf_ended, doubt_valid, end_found, near_tie;
  logic [30:0] traversal_t_max, leaf_t_max, box_t_max;
  logic [Rays-1:0] testing, found_q, any_hit_q;
  logic [31:0] tag_0, tag_1, result_tag, end_triangle, end_t;  // tag_0, tag_1: tags of rays 0 and 1
  logic [TErrorWidth-1:0] end_t_error;
  logic [TestsWidth-1:0] end_tests;
  logic [95:0] over_point, result_point;
  logic [95:0] end_point, read_point;  // read_point: P of the ray addressed in the previous clock
  logic read_before;
  logic traversal_ray_q, leaf_ray_q, box_ray_q, traversal_before, leaf_before, box_before;
  logic replace, test_q, test_ray_q, push, doubts_space, doubts_valid;
  logic [63:0] pushed, doubt_word;
  logic [4:0] doubts, here;
  logic [Rays*31-1:0] t_max_words;
  logic [Rays*32-1:0] nearest_t, nearest_low, nearest_triangle;
  logic over, over_sure, over_vague, over_ray, old_found;
  logic [31:0] over_tag, over_triangle, over_t, over_low, over_high, old_low, old_triangle;
  logic [30:0] old_t_max;
  logic [TErrorWidth-1:0] over_t_error;
  logic [Rays*TErrorWidth-1:0] nearest_error;
  logic [Rays*96-1:0] points;
  logic [Rays*5-1:0] counts;
  logic [Rays*TestsWidth-1:0] tests;

  opened_closest_hit dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .load_i(load),
    .load_ray_i(load_ray),
    .load_t_max_i(load_t_max),
    .load_any_hit_i(load_any_hit),
    .test_i(test),
    .test_ray_i(test_ray),
    .settle_i(1'b0),
    .exact_ray_i(1'b0),
    .tests_allowed_o(tests_allowed),
    .result_ray_i(read_ray),
    .result_tag_i(read_ray ? tag_1 : tag_0),
    .result_i({read, read_skipped, read_doubt, read_hit, read_triangle, read_t, read_t_error,
               read_normal_error, read_distance_error, point}),
    .failed_i(failed),
    .traversal_ray_i(traversal_ray),
    .traversal_t_max_o(traversal_t_max),
    .traversal_ended_o(traversal_ended),
    .leaf_ray_i(leaf_ray),
    .leaf_t_max_o(leaf_t_max),
    .leaf_ended_o(leaf_ended),
    .box_ray_i(box_ray),
    .box_t_max_o(box_t_max),
    .testing_o(testing),
    .doubt_o({doubt_valid, doubt_word}),
    .doubt_fire_i(doubt_fire),
    .end_ray_i(end_ray),
    .end_o({end_found, end_triangle, end_t, end_t_error, end_tests}),
    .point_ray_i(point_ray),
    .point_o(end_point),
    .near_tie_o(near_tie),
    .found_q(found_q),
    .any_hit_q(any_hit_q),
    .traversal_ray_q(traversal_ray_q),
    .leaf_ray_q(leaf_ray_q),
    .box_ray_q(box_ray_q),
    .is_over_q(over),
    .is_sure_q(over_sure),
    .is_vague_q(over_vague),
    .ray_q(over_ray),
    .tag_q(over_tag),
    .triangle_q(over_triangle),
    .t_q(over_t),
    .t_error_q(over_t_error),
    .low_q(over_low),
    .high_q(over_high),
    .old_found_q(old_found),
    .old_t_max_q(old_t_max),
    .old_low_q(old_low),
    .old_triangle_q(old_triangle),
    .replace(replace),
    .here_q(here),
    .test_q(test_q),
    .test_ray_q(test_ray_q),
    .\u_doubts.push_i (push),
    .\u_doubts.data_i (pushed),
    .\u_doubts.count_q (doubts),
    .point_q(over_point),
    .t_max(t_max_words),
    .nearest_t(nearest_t),
    .nearest_low(nearest_low),
    .nearest_error(nearest_error),
    .nearest_triangle(nearest_triangle),
    .u_kept_words(points),
    .tests(tests),
    .counts(counts)
  );

  // ---- The result being compared: the inputs of the previous clock
  logic result, result_ray, result_skipped, result_doubt, result_hit;
  logic [31:0] result_triangle, result_t;
  logic [3:0] result_t_error, result_normal_error, result_distance_error;
  always_ff @(posedge clk) begin
    result <= reset_n && read;
    {result_ray, result_skipped, result_doubt, result_hit} <= {read_ray, read_skipped, read_doubt, read_hit};
    {result_triangle, result_t, result_point} <= {read_triangle, read_t, point};
    {result_t_error, result_normal_error, result_distance_error}
        <= {read_t_error, read_normal_error, read_distance_error};
  end
  initial result = 1'b0;

  // ---- Assumptions about the user

  logic [Rays-1:0] loaded, any_hit;
  logic [11:0] flight_0, flight_1;  // tests in flight, of rays 0 and 1
  logic [TestsWidth-1:0] made_0, made_1;  // number of tests of rays 0 and 1
  logic [30:0] user_0, user_1;  // the user's t_max of rays 0 and 1

  assign result_tag = result_ray ? tag_1 : tag_0;
  always_ff @(posedge clk) begin
    if (!reset_n) begin
      loaded <= '0;
      flight_0 <= '0;
      flight_1 <= '0;
    end else begin
      flight_0 <= flight_0 + 12'(test && !test_ray) - 12'(result && !result_ray);
      flight_1 <= flight_1 + 12'(test && test_ray) - 12'(result && result_ray);
      made_0 <= made_0 + TestsWidth'(test && !test_ray);
      made_1 <= made_1 + TestsWidth'(test && test_ray);
      if (load) begin
        loaded[load_ray] <= 1'b1;
        any_hit[load_ray] <= load_any_hit;
        if (load_ray) begin
          tag_1 <= load_tag;
          user_1 <= load_t_max;
          made_1 <= '0;
        end else begin
          tag_0 <= load_tag;
          user_0 <= load_t_max;
          made_0 <= '0;
        end
      end
    end
  end

  always_comb begin
    if (reset_n) begin
      assume (!load || ((load_ray ? flight_1 : flight_0) == '0 && load_t_max <= Infinity[30:0]
                        && !(test && test_ray == load_ray)));
      assume (!test || (loaded[test_ray] && test_ray == leaf_ray_q && tests_allowed));
      assume (!read || (read_ray ? flight_1 : flight_0) > 12'(result && result_ray == read_ray));
      assume (!(read_hit && read_doubt) && read_t <= Infinity);
      assume (!doubt_fire || doubt_valid);
    end else begin
      assume (!load && !test && !read && !doubt_fire);
    end
  end

  // ---- The verdict on the result being compared

  logic good, sure, vague;  // good: the error of t is bounded; vague: neither a sure hit nor a sure miss
  logic [TErrorWidth-1:0] t_error;
  assign good = set_up_pkg::is_good_hit(TErrorWidth'(result_t_error), result_normal_error);
  assign t_error = set_up_pkg::t_error_exponent(TErrorWidth'(result_t_error), result_normal_error,
                                                result_distance_error);
  assign sure  = result && !result_skipped && result_hit && good;
  assign vague = result && !result_skipped && (result_doubt || (result_hit && !good));

  // Bounds of the exact t, as bit patterns of floats
  logic signed [33:0] low, high;
  assign low  = $signed({2'b00, result_t}) - $signed(34'd1 << t_error);
  assign high = $signed({2'b00, result_t}) + $signed(34'd1 << t_error);

  // ---- The watched hit

  localparam logic [1:0] Nowhere = 2'd0, Kept = 2'd1, Told = 2'd2, Beyond = 2'd3;
  logic [1:0] state;
  logic w_ray;
  logic [31:0] w_t, w_triangle;
  logic [TErrorWidth-1:0] w_error;
  logic [95:0] w_point;
  logic signed [33:0] w_low, w_high;
  logic [30:0] w_t_max;  // t_max of the watched hit's ray
  logic ousted;
  initial state = Nowhere;

  assign w_t_max = w_ray ? t_max_words[61:31] : t_max_words[30:0];
  assign ousted  = state == Kept && result && result_ray == w_ray && replace;

  always_ff @(posedge clk) begin
    if (!reset_n) begin
      state <= Nowhere;
    end else if (state == Nowhere) begin
      if (sure && choose) begin
        state <= replace ? Kept : push ? Told : Beyond;
        w_ray <= result_ray;
        w_t <= result_t;
        w_error <= t_error;
        w_triangle <= result_triangle;
        w_low <= low;
        w_high <= high > $signed({2'b00, Infinity}) ? $signed({2'b00, Infinity}) : high;
        w_point <= result_point;
      end
    end else begin
      if (load && load_ray == w_ray) state <= Nowhere;
      else if (ousted) state <= push ? Told : Beyond;
    end
  end

  always_ff @(posedge clk) begin
    read_point <= points[96*point_ray+:96];
    read_before <= reset_n;
    {traversal_before, leaf_before, box_before} <= {traversal_ray, leaf_ray, box_ray};
  end
  initial read_before = 1'b0;

  // ---- Claims

  logic [30:0] result_t_max;
  assign result_t_max = result_ray ? t_max_words[61:31] : t_max_words[30:0];

  always_comb begin
    if (reset_n) begin
      if (vague) assert (push && pushed == {result_tag, result_triangle} && !replace);
      if (sure && !replace && push) assert (pushed == {result_tag, result_triangle});
      if (sure && !replace && !push) assert (low > $signed({3'b000, result_t_max}));
      if (replace) assert (sure);
      if (push) assert (vague || sure);
      if (push && replace) assert (found_q[result_ray] && near_tie);
      if (ousted && push) assert (pushed == {result_tag, w_triangle});
      if (state == Beyond) assert (w_low > $signed({3'b000, w_t_max}));
      if (state != Nowhere) assert ($signed({3'b000, w_t_max}) <= w_high);
      if (state == Kept) begin
        assert (found_q[w_ray] && $signed({3'b000, w_t_max}) == w_high);
        assert (nearest_t[32*w_ray+:32] == w_t && nearest_triangle[32*w_ray+:32] == w_triangle
                && nearest_error[TErrorWidth*w_ray+:TErrorWidth] == w_error);
        assert (points[96*w_ray+:96] == w_point);
      end
      assert (end_found == found_q[end_ray] && end_t == nearest_t[32*end_ray+:32]
              && end_triangle == nearest_triangle[32*end_ray+:32]
              && end_t_error == nearest_error[TErrorWidth*end_ray+:TErrorWidth]);
      if (read_before) begin
        assert (end_point == read_point);
        assert ({traversal_ray_q, leaf_ray_q, box_ray_q} == {traversal_before, leaf_before, box_before});
      end
      // The user's t_max holds until a hit is kept
      if (loaded[0]) assert (found_q[0] ? t_max_words[30:0] < user_0 : t_max_words[30:0] == user_0);
      if (loaded[1]) assert (found_q[1] ? t_max_words[61:31] < user_1 : t_max_words[61:31] == user_1);
      if (loaded[traversal_ray_q]) begin
        assert (traversal_t_max == (traversal_ray_q ? t_max_words[61:31] : t_max_words[30:0])
                && traversal_ended == (failed[traversal_ray_q]
                                       || (found_q[traversal_ray_q] && any_hit[traversal_ray_q])));
      end
      if (loaded[leaf_ray_q]) begin
        assert (leaf_t_max == (leaf_ray_q ? t_max_words[61:31] : t_max_words[30:0])
                && leaf_ended == (failed[leaf_ray_q] || (found_q[leaf_ray_q] && any_hit[leaf_ray_q])));
      end
      assert (box_t_max == (box_ray_q ? t_max_words[61:31] : t_max_words[30:0]));
      // Tests
      assert (testing == {flight_1 != '0, flight_0 != '0});
      if (loaded[0]) assert ({7'd0, counts[4:0]} == flight_0 - 12'(test_q && !test_ray_q));
      if (loaded[1]) assert ({7'd0, counts[9:5]} == flight_1 - 12'(test_q && test_ray_q));
      if (test_q) assert (loaded[test_ray_q] && (test_ray_q ? flight_1 : flight_0) != '0);
      assert (end_tests == tests[TestsWidth*end_ray+:TestsWidth]);
      if (loaded[0]) assert (tests[TestsWidth-1:0] == made_0 - TestsWidth'(test_q && !test_ray_q));
      if (loaded[1]) assert (tests[2*TestsWidth-1:TestsWidth] == made_1 - TestsWidth'(test_q && test_ray_q));
      // Room for doubts
      assert ({7'd0, here} == flight_0 + flight_1 + {7'd0, doubts} && here <= 5'(Queue));
      assert (flight_0 <= 12'(Queue) && flight_1 <= 12'(Queue) && doubts <= 5'(Queue));

      // Invariants
      if (result) begin
        assert (loaded[result_ray] && (result_ray ? counts[9:5] : counts[4:0]) != '0);
        assert (!(result_hit && result_doubt) && result_t <= Infinity);
        assert (over_ray == result_ray && over_triangle == result_triangle && over_t == result_t
                && over_point == result_point);
        assert (over_tag == result_tag && over_t_error == t_error);
        assert ($signed({2'b00, over_low}) == (low > 0 ? low : 34'sd0));
        assert ($signed({2'b00, over_high}) == (high < $signed({2'b00, Infinity}) ? high : $signed({2'b00, Infinity})));
        assert (old_found == found_q[result_ray] && old_t_max == result_t_max);
        if (old_found) begin
          assert (old_low == nearest_low[32*result_ray+:32]
                  && old_triangle == nearest_triangle[32*result_ray+:32]);
        end
      end
      assert (over == result && over_sure == sure && over_vague == vague);
      if (state == Kept) assert ($signed({2'b00, nearest_low[32*w_ray+:32]}) == (w_low > 0 ? w_low : 34'sd0));
      assert (tests_allowed == (here < 5'(Queue)) && (!doubt_valid || doubts != '0));
      if (!loaded[0]) assert (flight_0 == '0);
      if (!loaded[1]) assert (flight_1 == '0);
      if (loaded[0]) assert (any_hit_q[0] == any_hit[0]);
      if (loaded[1]) assert (any_hit_q[1] == any_hit[1]);
      if (state != Nowhere) begin
        assert (loaded[w_ray] && w_t <= Infinity);
        assert (w_low == $signed({2'b00, w_t}) - $signed(34'd1 << w_error));
      end

      cover (state == Kept && end_ray == w_ray);
      cover (ousted && push);
      cover (ousted && !push);
      cover (state == Beyond && doubts != '0);
      cover (state == Told && end_found && end_ray == w_ray);
    end
  end

endmodule
