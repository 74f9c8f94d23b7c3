// All kinds of adder at many widths with the same operands, compared with one 65-bit sum from the test. Leading-zero
// counters, compared with shifts.
//
// One expected sum, expected_i = a_i + b_i + carry_i, is enough for all widths: the low bits of a sum do not depend on
// the width, and the carry out of W bits is a[W] ^ b[W] ^ sum[W].
module adders_top (
  input  logic        clk_i,
  input  logic [63:0] a_i,
  input  logic [63:0] b_i,
  input  logic        carry_i,
  input  logic [64:0] expected_i,
  output logic [9:0]  wrong_width_o,  // bit k: an adder of width Widths[k]
  output logic [8:0]  wrong_kind_o,   // bit k: an adder of kind k, see below
  output logic [9:0]  wrong_other_o   // bit k: another module of width Widths[k]
);

  localparam int unsigned NumWidths = 10;
  localparam bit [8*NumWidths-1:0] Widths = {
    8'd64, 8'd48, 8'd24, 8'd13, 8'd12, 8'd8, 8'd5, 8'd3, 8'd2, 8'd1
  };
  localparam int unsigned NumKinds = 9;

  // Group widths that no kind of adder uses by default: growing, shrinking, single bits.
  function automatic bit [8*arith_pkg::MaxGroups-1:0] odd_groups(int unsigned width);
    int unsigned left, size;
    left = width;
    odd_groups = '0;
    for (int unsigned k = 0; k < 15; k++) begin
      size = (k % 3 == 0) ? 1 : (k % 3 == 1) ? 9 : 4;
      if (left < size) size = left;
      odd_groups[8*k +: 8] = 8'(size);
      left = left - size;
    end
  endfunction

  logic [63:0] a, b;
  logic carry;
  logic [64:0] expected, carries;

  always_ff @(posedge clk_i) begin
    a        <= a_i;
    b        <= b_i;
    carry    <= carry_i;
    expected <= expected_i;
  end

  assign carries = expected ^ {1'b0, a} ^ {1'b0, b};  // carry into each bit

  for (genvar w = 0; w < NumWidths; w++) begin : gen_width
    localparam int unsigned Width = 32'(Widths[8*w+:8]);
    logic [NumKinds-1:0] wrong, wrong_so_far;

    // k = 0 to 4: the kinds of arithmetic. 5: graded groups, even where one group is the default. 6: uniform ripple
    // groups. 7 and 8: odd_groups with look-ahead and with ripple.
    for (genvar k = 0; k < NumKinds; k++) begin : gen_kind
      localparam int unsigned Arith = (k < 5) ? k : (k == 6) ? arith_pkg::Uniform : arith_pkg::Graded;
      localparam bit LookAhead = (k < 6) || (k == 7);
      localparam bit [8*arith_pkg::MaxGroups-1:0] GroupWidths = (k == 5) ? arith_pkg::graded_groups(
        Width
      ) : (k >= 7) ? odd_groups(
        Width
      ) : '0;
      logic [Width-1:0] sum;
      logic carry_out;

      adder #(
        .Width      (Width),
        .Arith      (Arith),
        .GroupWidths(GroupWidths),
        .LookAhead  (LookAhead)
      ) u_adder (
        .a_i    (a[Width-1:0]),
        .b_i    (b[Width-1:0]),
        .carry_i(carry),
        .sum_o  (sum),
        .carry_o(carry_out)
      );

      assign wrong[k] = (sum != expected[Width-1:0]) | (carry_out != carries[Width]);
    end

    if (Width >= 2) begin : gen_others
      logic [1:0] wrong_other;
      logic [$clog2(Width)-1:0] zeros;
      logic zero;
      leading_zero_counter #(.Width(Width)) u_zeros (
        .a_i(a[Width-1:0]), .count_o(zeros), .zero_o(zero));
      assign wrong_other[0] = zero != (a[Width-1:0] == '0);
      assign wrong_other[1] = ~zero & ((a[Width-1:0] << zeros >> (Width - 1)) != Width'(1)
                                     | (a[Width-1:0] << zeros >> zeros) != a[Width-1:0]);
      assign wrong_other_o[w] = |wrong_other;
    end else begin : gen_no_others
      assign wrong_other_o[w] = 1'b0;
    end

    assign wrong_width_o[w] = |wrong;
    if (w == 0) begin : gen_first
      assign wrong_so_far = wrong;
    end else begin : gen_next
      assign wrong_so_far = wrong | gen_width[w-1].wrong_so_far;
    end
  end

  assign wrong_kind_o = gen_width[NumWidths-1].wrong_so_far;

endmodule
