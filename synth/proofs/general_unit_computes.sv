// Claim: for a test taken in any state of general_hit_test_unit, the three output components, 13, 14 and 15 clocks
// later, are O_k + t I_k with t = -(((d + a Ox) + b Oy) + c Oz) / ((a Ix + b Iy) + c Iz). Other inputs are arbitrary,
// and so are the functions that the float cores compute. The next test may come 10 clocks after this test.
module general_unit_computes #(
  localparam int unsigned Width = 32
) (
  input logic             clk,
  input logic             valid,
  input logic [Width-1:0] bus
);

  logic [4:0] age;  // clocks since the test was taken, in the first clock
  initial age = '0;
  always_ff @(posedge clk) if (age != '1) age <= age + 1'b1;

  logic ready, output_valid;
  logic [Width-1:0] out;

  general_hit_test_unit dut (  // initially in any state in which a test is offered and taken
    .clk_i(clk),
    .rst_ni(1'b1),
    .valid_i(valid),
    .ready_o(ready),
    .bus_i(bus),
    .bus_o(out),
    .valid_o(output_valid)
  );
  always_comb assume (age != '0 || valid && ready);

  logic [10*Width-1:0] words;  // the test's words, in the order of arrival: d, a b c, Ox Oy Oz, Ix Iy Iz
  always_ff @(posedge clk) if (age < 5'd10) words[Width*age+:Width] <= bus;

  // ---- The expected component, from the test's words

  logic [4*Width-1:0] numerators, divisors;
  logic [Width-1:0] t, moved, component;

  assign numerators[0+:Width] = words[0+:Width];
  assign divisors[0+:Width] = '0;  // unused
  for (genvar k = 0; k < 3; k++) begin : gen_product
    logic [Width-1:0] of_origin, of_direction;
    fp_multiplier #(.ConstantRow(1'b1)) u_multiply_origin (
      .clk_i(clk), .a_i(words[Width*(1+k)+:Width]), .b_i(words[Width*(4+k)+:Width]),
      .rounding_mode_i(3'd0), .tininess_after_i(1'b1), .result_o(of_origin));
    fp_adder u_add_origin (
      .clk_i(clk), .a_i(numerators[Width*k+:Width]), .b_i(of_origin), .subtract_i(1'b0),
      .rounding_mode_i(3'd0), .tininess_after_i(1'b1), .result_o(numerators[Width*(k+1)+:Width]));
    fp_multiplier #(.ConstantRow(1'b1)) u_multiply_direction (
      .clk_i(clk), .a_i(words[Width*(1+k)+:Width]), .b_i(words[Width*(7+k)+:Width]),
      .rounding_mode_i(3'd0), .tininess_after_i(1'b1), .result_o(of_direction));
    if (k == 0) begin : gen_first
      assign divisors[Width+:Width] = of_direction;
    end else begin : gen_next
      fp_adder u_add_direction (
        .clk_i(clk), .a_i(divisors[Width*k+:Width]), .b_i(of_direction), .subtract_i(1'b0),
        .rounding_mode_i(3'd0), .tininess_after_i(1'b1), .result_o(divisors[Width*(k+1)+:Width]));
    end
  end
  fp_divider u_divide (
    .clk_i(clk), .valid_i(1'b1),
    .a_i({~numerators[4*Width-1], numerators[3*Width+:Width-1]}), .b_i(divisors[3*Width+:Width]),
    .rounding_mode_i(3'd0), .tininess_after_i(1'b1), .result_o(t));
  fp_multiplier #(.ConstantRow(1'b1)) u_move (
    .clk_i(clk), .a_i(t), .b_i(words[Width*(age-6)+:Width]), .rounding_mode_i(3'd0),
    .tininess_after_i(1'b1), .result_o(moved));
  fp_adder u_component (
    .clk_i(clk), .a_i(words[Width*(age-9)+:Width]), .b_i(moved), .subtract_i(1'b0),
    .rounding_mode_i(3'd0), .tininess_after_i(1'b1), .result_o(component));

  always_comb begin
    if (age >= 5'd13 && age <= 5'd15) assert (output_valid && out == component);
    if (age >= 5'd1 && age <= 5'd10) assert (ready == (age == 5'd10));
    cover (age == 5'd15);
  end

endmodule
