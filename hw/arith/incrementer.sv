// Adds a carry of one to a word, the carry being the last to arrive.
//
// Where the low bits are all ones the carry passes, so ones_below[i] (bits i-1 .. 0 are all ones)
// is found by a prefix AND of $clog2(Width) levels before the carry is known; the carry then costs
// one AND and one XOR. A rounder has its decision late and its word early.
//
// Arith: Behavioural is the language's own `+`.
// Combinational. Any input; all ones wrap to zero.
module incrementer #(
  parameter int unsigned Width = 8,
  parameter int unsigned Arith = arith_pkg::Graded
) (
  input  logic [Width-1:0] a_i,
  input  logic             carry_i,
  output logic [Width-1:0] sum_o
);

  if (Width < 2 || Arith > arith_pkg::Prefix) begin : gen_check
    $error("incrementer: expected a Width of 2 or more and an Arith of arith_pkg::arith_e");
  end

  if (Arith == arith_pkg::Behavioural) begin : gen_behavioural
    assign sum_o = a_i + Width'(carry_i);
  end else begin : gen_prefix
    localparam int unsigned Levels = $clog2(Width);

    // After level k bit i is the AND of the 2**k bits that end at bit i - 1, ones shifted in below.
    logic [Width-1:0] ones_below;

    always_comb begin
      ones_below = {a_i[Width-2:0], 1'b1};
      for (int unsigned k = 0; k < Levels; k++) begin
        ones_below = ones_below & ((ones_below << (1 << k)) | ~({Width{1'b1}} << (1 << k)));
      end
    end

    assign sum_o = a_i ^ (ones_below & {Width{carry_i}});
  end

endmodule
