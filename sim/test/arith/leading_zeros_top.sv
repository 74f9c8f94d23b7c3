// Leading-zero counters of every width from 2 to 64 on the low bits of one word.
module leading_zeros_top (
  input  logic            clk_i,
  input  logic [63:0]     a_i,
  output logic [8*65-1:0] count_o  // a byte for each width, its top bit for zero; 0 for 0 and 1
);

  logic [63:0] a;

  always_ff @(posedge clk_i) a <= a_i;

  assign count_o[15:0] = '0;

  for (genvar w = 2; w <= 64; w++) begin : gen_width
    logic [$clog2(w)-1:0] count;

    leading_zero_counter #(
      .Width(w)
    ) u_counter (
      .a_i    (a[w-1:0]),
      .count_o(count),
      .zero_o (count_o[8*w+7])
    );

    assign count_o[8*w+:7] = 7'(count);
  end

endmodule
