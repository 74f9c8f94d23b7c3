// Counts the zeros above the highest 1 of a word.
//
// Setting all bits below the highest 1 turns the word into a run of ones; its top, bit p, marks the highest 1. The
// count is Width - 1 - p. So bit j of count_o is the OR of the marks of all p with a 1 in bit j of Width - 1 - p.
//
// Combinational: $clog2(Width) levels, one AND, one OR of half the bits. If a_i is 0, zero_o is 1, count_o all ones.
module leading_zero_counter #(
  parameter int unsigned Width = 24
) (
  input  logic [Width-1:0]         a_i,
  output logic [$clog2(Width)-1:0] count_o,
  output logic                     zero_o
);

  localparam int unsigned CountWidth = $clog2(Width);

  if (Width < 2) begin : gen_check
    $error("leading_zero_counter: expected a Width of 2 or more");
  end

  // Returns a mask of the bit positions p for which bit j of Width - 1 - p is 1.
  function automatic bit [Width-1:0] places(int unsigned j);
    for (int unsigned i = 0; i < Width; i++) places[Width-1-i] = ((i >> j) % 2) == 1;
  endfunction

  logic [Width-1:0] smeared, highest;

  always_comb begin
    smeared = a_i;
    highest = a_i;
    count_o = '0;
    if (!a_i[Width-1]) begin
      for (int unsigned step = 1; step < Width; step = step * 2) begin
        smeared = smeared | (smeared >> step);
      end
      highest = smeared & ~(smeared >> 1);
      for (int unsigned j = 0; j < CountWidth; j++) begin
        count_o[j] = ~smeared[0] | (|(highest & places(j)));
      end
    end
  end
  assign zero_o = a_i == '0;

endmodule
