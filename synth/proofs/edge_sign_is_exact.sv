// Claim, for every ray and record in a small format: if |U| exceeds the bound, U has the sign of the exact edge product
// J . E. J is the ray's direction. E is the exact edge vector. Its components round to the record's words F; therefore
// |E_i - F_i| is at most half a unit in the last place of F_i. U is J . F as computed by the float cores.
// Assumed, from scaling at set-up: |J_i| < 2, |F_i| < 2, and at least one |F_i| >= 1. The bound on |U| is any number >=
// C 2^-(FracWidth+1) (|F_0| + |F_1| + |F_2|), with C = C1024 / 1024. All sums here are integers, in units of the
// format's smallest number or of its square.
module edge_sign_is_exact #(
  parameter int unsigned ExpWidth  = 4,
  parameter int unsigned FracWidth = 3,
  parameter int unsigned C1024     = 8200,
  parameter int unsigned Arith     = 0,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input logic [3*Width-1:0] direction,
  input logic [3*Width-1:0] edge_words,
  input logic [Width-1:0]   bound
);

  localparam int unsigned Bias = 2 ** (ExpWidth - 1) - 1;
  localparam int unsigned Whole = FracWidth + Bias + 1;  // bits of a number below 2, as an integer
  localparam int unsigned Wide = 2 * Whole + 4;

  // ---- U, computed as in the unit

  logic [3*Width-1:0] products;
  logic [Width-1:0] sum, u;
  logic [4:0] unused[5];

  for (genvar k = 0; k < 3; k++) begin : gen_product
    logic [4:0] flags;
    fp_multiplier #(
      .ExpWidth(ExpWidth),
      .FracWidth(FracWidth),
      .Arith(Arith)
    ) multiplier (
      .a_i(edge_words[Width*k+:Width]),
      .b_i(direction[Width*k+:Width]),
      .rounding_mode_i(3'd0),
      .tininess_after_i(1'b0),
      .result_o(products[Width*k+:Width]),
      .flags_o(flags)
    );
  end
  logic [4:0] first_flags, second_flags;
  fp_adder #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .Arith(Arith)
  ) first (
    .a_i(products[0+:Width]),
    .b_i(products[Width+:Width]),
    .subtract_i(1'b0),
    .rounding_mode_i(3'd0),
    .tininess_after_i(1'b0),
    .result_o(sum),
    .flags_o(first_flags)
  );
  fp_adder #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth),
    .Arith(Arith)
  ) second (
    .a_i(sum),
    .b_i(products[2*Width+:Width]),
    .subtract_i(1'b0),
    .rounding_mode_i(3'd0),
    .tininess_after_i(1'b0),
    .result_o(u),
    .flags_o(second_flags)
  );

  // ---- whole: the magnitude of a word as an integer; place: the unit in its last place

  function automatic [Wide-1:0] whole(input [Width-1:0] word);
    logic [ExpWidth-1:0] exponent;
    exponent = word[FracWidth+:ExpWidth];
    whole = Wide'({exponent != '0, word[FracWidth-1:0]}) << (exponent == '0 ? 0 : exponent - 1'b1);
  endfunction
  function automatic [Wide-1:0] place(input [Width-1:0] word);
    logic [ExpWidth-1:0] exponent;
    exponent = word[FracWidth+:ExpWidth];
    place = Wide'(1) << (exponent == '0 ? 0 : exponent - 1'b1);
  endfunction

  // ---- twice_exact = 2 J . F, exact. unsure >= 2 |J . (E - F)|: E differs from F by the record's rounding

  logic [Wide-1:0] twice_exact, unsure, size, one;
  logic below_two, is_large;
  always_comb begin
    twice_exact = '0;
    unsure = '0;
    size = '0;
    below_two = 1'b1;
    is_large = 1'b0;
    for (int unsigned k = 0; k < 3; k++) begin
      one = whole(direction[Width*k+:Width]) * whole(edge_words[Width*k+:Width]);
      if (direction[Width*k+Width-1] ^ edge_words[Width*k+Width-1]) begin
        twice_exact = twice_exact - 2 * one;
      end else begin
        twice_exact = twice_exact + 2 * one;
      end
      unsure = unsure + whole(direction[Width*k+:Width]) * place(edge_words[Width*k+:Width]);
      size = size + whole(edge_words[Width*k+:Width]);
      below_two = below_two && direction[Width*k+FracWidth+:ExpWidth] <= ExpWidth'(Bias)
                  && edge_words[Width*k+FracWidth+:ExpWidth] <= ExpWidth'(Bias);
      is_large = is_large || edge_words[Width*k+FracWidth+:ExpWidth] == ExpWidth'(Bias);
    end
  end

  localparam int unsigned BoundWide = Wide + 16 + FracWidth;
  localparam logic [Width-2:0] Infinity = {{ExpWidth{1'b1}}, {FracWidth{1'b0}}};

  always_comb begin
    assume (below_two && is_large && !bound[Width-1] && bound[Width-2:0] < Infinity);
    assume ((BoundWide'(whole(bound)) << (11 + FracWidth)) >= BoundWide'(size) * BoundWide'(C1024));
    if (u[Width-2:0] > bound[Width-2:0]) begin
      assert (u[Width-2:0] < Infinity);
      assert (u[Width-1] == twice_exact[Wide-1]);
      assert (twice_exact[Wide-1] ? -twice_exact > unsure : twice_exact > unsure);
    end
    cover (u[Width-2:0] > bound[Width-2:0] && u[Width-1]);
  end

endmodule
