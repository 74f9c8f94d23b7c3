// Claim: the paper's unit follows its timetable (figure 9), whenever tests come and whenever the unit is reset. k
// clocks after a test is taken, word k of the test is on the bus (k = 1 to 6), or division k - 6 is done (k = 7 to 9).
// A component of P is at the output exactly 8, 9 and 10 clocks after a test is taken. The unit is ready exactly when no
// test was taken in the last 6 clocks. Each register's enable is set in the clocks that the timetable states.
module timetable (
  input logic        clk,
  input logic        reset_n,
  input logic        valid,
  input logic [31:0] bus
);

  logic ready, output_valid;
  logic [31:0] out;
  logic [2:0] word;
  logic [1:0] step;
  logic clear, accumulate, load_d, divide;

  opened_hit_test_unit dut (  // the unit with its counters and enables as outputs
    .clk_i(clk),
    .rst_ni(reset_n),
    .valid_i(valid),
    .ready_o(ready),
    .bus_i(bus),
    .bus_o(out),
    .valid_o(output_valid),
    .word(word),
    .step(step),
    .clear(clear),
    .accumulate(accumulate),
    .load_d(load_d),
    .divide(divide)
  );

  // taken[k]: a test was taken k clocks ago
  logic [10:1] taken;
  initial taken = '0;
  always_ff @(posedge clk) begin
    if (!reset_n) begin
      taken <= '0;
    end else begin
      taken <= {taken[9:1], valid && ready};
    end
  end

  logic first;
  initial first = 1'b1;
  always_ff @(posedge clk) first <= 1'b0;
  always_comb assume (!first || !reset_n);

  logic [2:0] expected_word;
  logic [1:0] expected_step;
  always_comb begin
    expected_word = '0;
    for (int unsigned k = 1; k <= 6; k++) if (taken[k]) expected_word = expected_word | 3'(k);
    expected_step = '0;
    for (int unsigned k = 7; k <= 9; k++) if (taken[k]) expected_step = expected_step | 2'(k - 6);
  end

  always_comb begin
    if (reset_n && !first) begin
      assert (ready == (taken[6:1] == '0));
      assert (word == expected_word);
      assert (step == expected_step);
      assert (clear == taken[3]);
      assert (accumulate == (taken[6:4] != '0));
      assert (load_d == taken[6]);
      assert (divide == (taken[9:7] != '0));
      assert (output_valid == (taken[10:8] != '0));
      cover (output_valid && taken[10] && taken[3]);
    end
  end

endmodule
