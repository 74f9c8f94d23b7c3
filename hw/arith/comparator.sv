// Compares two unsigned words: less_o = a_i < b_i, equal_o = a_i == b_i.
//
// A tree: each level joins pairs of neighbours, the upper one deciding unless it is equal. Written
// as word-wide steps, of which all but the tree that ends in the top bit is pruned by synthesis.
//
// Arith: Behavioural is the language's own `<` and `==`.
// Combinational, $clog2(Width) levels. Any input.
module comparator #(
  parameter int unsigned Width = 31,
  parameter int unsigned Arith = arith_pkg::Graded
) (
  input  logic [Width-1:0] a_i,
  input  logic [Width-1:0] b_i,
  output logic             less_o,
  output logic             equal_o
);

  if (Arith > arith_pkg::Prefix) begin : gen_check
    $error("comparator: expected an Arith of arith_pkg::arith_e");
  end

  if (Arith == arith_pkg::Behavioural) begin : gen_behavioural
    assign less_o = a_i < b_i;
    assign equal_o = a_i == b_i;
  end else begin : gen_tree
    // After level k bit i tells of the 2**k bits that end at bit i (of fewer at the low end, where
    // the bits shifted in count as equal).
    logic [Width-1:0] less, equal;

    always_comb begin
      less = ~a_i & b_i;
      equal = ~(a_i ^ b_i);
      for (int unsigned k = 0; k < $clog2(Width); k++) begin
        less = less | (equal & (less << (1 << k)));
        equal = equal & ((equal << (1 << k)) | ~({Width{1'b1}} << (1 << k)));
      end
    end

    assign less_o = less[Width-1];
    assign equal_o = equal[Width-1];
  end

endmodule
