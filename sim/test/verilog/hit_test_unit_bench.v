// hit_test_unit, written by `make synth VERILOG=1` with the paper's divider: its worked example, word for word.
module bench;
  reg  clk = 0, reset_n = 0, valid = 0;
  reg  [31:0] in = 0;
  wire ready, out_valid;
  wire [31:0] out;
  reg  [7*32-1:0] words = {32'h40540000, 32'h40bc0000, 32'h403b0000,   // Ix Iy Iz
                           32'h41730000, 32'h3ef00000, 32'h40070000,   // a b c
                           32'h3fe00000};                              // d
  reg  [3*32-1:0] expected = {32'h3dc873f8, 32'h3e31c2a0, 32'h3db0d090};
  integer edges, cases = 0, failures = 0;

  hit_test_unit dut (
    .clk_i(clk), .rst_ni(reset_n), .valid_i(valid), .ready_o(ready), .bus_i(in), .bus_o(out),
    .valid_o(out_valid)
  );

  initial begin
    #1 reset_n = 1;
    for (edges = 1; edges <= 12; edges = edges + 1) begin
      valid = edges == 1;
      {in, words} = {words, 32'h0};
      #1 clk = 1;
      #1 clk = 0;
      if (out_valid !== (edges >= 8 && edges <= 10)) failures = failures + 1;
      if (out_valid) begin
        cases = cases + 1;
        if (out !== expected[95:64]) failures = failures + 1;
        $display("edge %0d: found %h, expected %h", edges, out, expected[95:64]);
        expected = expected << 32;
      end
    end
    $display("%0d cases, %0d failures", cases, failures);
  end
endmodule
