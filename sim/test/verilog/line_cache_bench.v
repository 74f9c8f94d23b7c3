// line_cache with four-state values, as it wakes up: the first miss of each set takes a way that is known.
module bench;
  reg  clk = 0, reset_n = 0, valid = 0, ready = 0;
  reg  [27:0] line = 0;
  wire miss;
  wire [7:0] entry;
  integer set, waited, cases = 0, failures = 0;

  line_cache dut (
    .clk_i(clk), .rst_ni(reset_n), .invalidate_i(1'b0), .valid_i(valid), .ready_o(), .demand_i(1'b1), .ray_i(6'd0),
    .line_number_i(line), .outstanding_o(), .miss_valid_o(miss), .miss_ready_i(ready), .miss_entry_o(entry), .miss_number_o(),
    .fill_i(1'b0), .fill_done_o(), .fill_entry_i(8'd0), .fill_line_i(512'd0), .fill_error_i(1'b0), .valid_o(),
    .ready_i(1'b1), .ray_o(), .line_o(), .error_o()
  );

  task tick;
    begin
      #1 clk = 1;
      #1 clk = 0;
      #1;
    end
  endtask

  initial begin
    #1 reset_n = 1;
    ready = 1;
    for (set = 0; set < 32; set = set + 1) begin
      line = set;
      valid = 1;
      tick;
      valid = 0;
      // Its tags are read, then compared.
      for (waited = 0; waited < 4 && miss !== 1'b1; waited = waited + 1) tick;
      if (miss !== 1'b1 || ^entry === 1'bx || entry[4:0] !== set) begin
        failures = failures + 1;
        $display("set %0d: found entry %b", set, entry);
      end
      cases = cases + 1;
      tick;  // the miss is taken
    end
    $display("%0d cases, %0d failures", cases, failures);
  end
endmodule
