// Simulates ram of 512 words of 72 bits in two parts, with random writes and reads. A read at the same edge as a write
// returns the old word. The output holds until the next read.
module bench;
  reg clk = 0, read = 0;
  reg [1:0] write = 0;
  reg [8:0] write_address, read_address;
  reg [71:0] data, expected = 72'bx, words[0:511];
  wire [71:0] word;
  integer clocks, seed = 1, cases = 0, failures = 0;

  ram dut (
    .clk_i(clk), .write_i(write), .write_address_i(write_address), .data_i(data), .read_i(read),
    .read_address_i(read_address), .data_o(word)
  );

  initial begin
    for (clocks = 0; clocks < 4000; clocks = clocks + 1) begin
      {write, read} = $random(seed);
      // Few addresses, near both ends
      write_address = $random(seed) & 9'h10f;
      read_address  = $random(seed) & 9'h10f;
      data = {$random(seed), $random(seed), $random(seed)};
      #1;
      if (read) expected = words[read_address];
      if (write[0]) words[write_address][35:0] = data[35:0];
      if (write[1]) words[write_address][71:36] = data[71:36];
      #1 clk = 1;
      #1 clk = 0;
      if (^expected !== 1'bx) begin
        cases = cases + 1;
        if (word !== expected) failures = failures + 1;
      end
    end
    $display("%0d cases, %0d failures", cases, failures);
  end
endmodule
