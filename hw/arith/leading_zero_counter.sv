// Counts the zeros above the highest one of a word.
//
// A tree: each level joins pairs of neighbouring blocks, whose count is that of the upper block,
// or, where that is all zeros, that of the lower block with one more bit set. So the count's high
// bits come first, when a barrel shifter wants them. Written as word-wide steps, of which all but
// the tree that ends in the top bit is pruned by synthesis.
//
// Combinational, $clog2(Width) levels. For a_i = 0, zero_o is 1 and count_o is all ones.
module leading_zero_counter #(
  parameter int unsigned Width = 24  // at least 2
) (
  input  logic [Width-1:0]         a_i,
  output logic [$clog2(Width)-1:0] count_o,
  output logic                     zero_o
);

  localparam int unsigned Levels = $clog2(Width);

  // After level k bit i tells of the 2**k bits that end at bit i (zeros are shifted in below):
  // whether any is one, and bit j of their count in plane j.
  logic [Width-1:0] any, plane[Levels];

  always_comb begin
    any = a_i;
    for (int unsigned j = 0; j < Levels; j++) plane[j] = '0;
    for (int unsigned k = 0; k < Levels; k++) begin
      for (int unsigned j = 0; j < k; j++) begin
        plane[j] = (any & plane[j]) | (~any & (plane[j] << (1 << k)));
      end
      plane[k] = ~any;
      any = any | (any << (1 << k));
    end
  end

  for (genvar j = 0; j < Levels; j++) begin : gen_count
    assign count_o[j] = plane[j][Width-1];
  end
  assign zero_o = ~any[Width-1];

endmodule
