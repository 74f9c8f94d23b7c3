// fp_adder_stages in binary16, written by `make synth VERILOG=1`: words that IEEE 754 gives.
module bench;
  reg  clk = 0;
  reg  [15:0] a, b;
  reg  subtract;
  reg  [2:0] mode;
  wire [15:0] sum;
  wire [4:0] flags;
  integer failures = 0, cases = 0;

  fp_adder_stages dut (
    .clk_i(clk), .a_i(a), .b_i(b), .subtract_i(subtract), .rounding_mode_i(mode),
    .tininess_after_i(1'b1), .result_o(sum), .flags_o(flags)
  );

  // After two clocks, the latency of PipeRegs = 3'b110.
  task check(input [15:0] x, input [15:0] y, input minus, input [2:0] rounding, input [15:0] expected,
             input inexact);
    begin
      a = x; b = y; subtract = minus; mode = rounding;
      repeat (2) begin #1 clk = 1; #1 clk = 0; end
      #1 cases = cases + 1;
      if (sum !== expected || flags[0] !== inexact) begin
        failures = failures + 1;
        $display("%h %s %h: found %h inexact %b, expected %h %b", x, minus ? "-" : "+", y, sum, flags[0],
                 expected, inexact);
      end
    end
  endtask

  initial begin
    check(16'h3c00, 16'h3c00, 0, 0, 16'h4000, 0);  // 1 + 1
    check(16'h3c00, 16'h1400, 0, 0, 16'h3c01, 0);  // 1 + 2^-10
    check(16'h3c00, 16'h1000, 0, 0, 16'h3c00, 1);  // 1 + 2^-11: a tie, to even
    check(16'h3c01, 16'h1000, 0, 0, 16'h3c02, 1);
    check(16'h3c00, 16'h1000, 0, 3, 16'h3c01, 1);  // upwards
    check(16'h3c00, 16'h3bff, 1, 0, 16'h1000, 0);  // 1 - (1 - 2^-11): 2^-11
    check(16'h0001, 16'h0001, 0, 0, 16'h0002, 0);  // subnormals
    check(16'h03ff, 16'h0001, 0, 0, 16'h0400, 0);  // into the normal ones
    check(16'h7bff, 16'h7bff, 0, 0, 16'h7c00, 1);  // overflow
    check(16'h7bff, 16'h7bff, 0, 1, 16'h7bff, 1);  // towards zero
    check(16'h3c00, 16'h3c00, 1, 0, 16'h0000, 0);  // +0
    check(16'h3c00, 16'h3c00, 1, 2, 16'h8000, 0);  // -0, downwards
    check(16'h7c00, 16'h7c00, 1, 0, 16'h7e00, 0);  // infinity - infinity
    $display("%0d cases, %0d failures", cases, failures);
  end
endmodule
