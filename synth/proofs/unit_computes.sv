// Claim: for a test taken in any state of the paper's unit, the three output components, 8, 9 and 10 clocks later, are
// (d I_k) / (((0 + a Ix) + b Iy) + c Iz). Other inputs are arbitrary, and so are the functions that the float cores
// compute. Proof timetable shows when the unit takes tests.
module unit_computes #(
  localparam int unsigned Width = 32
) (
  input logic             clk,
  input logic             valid,
  input logic [Width-1:0] bus
);

  logic [3:0] age;  // clocks since the test was taken, in the first clock
  initial age = '0;
  always_ff @(posedge clk) if (age != '1) age <= age + 1'b1;

  logic ready, output_valid;
  logic [Width-1:0] out;

  hit_test_unit dut (  // initially in any state in which a test is offered and taken
    .clk_i(clk),
    .rst_ni(1'b1),
    .valid_i(valid),
    .ready_o(ready),
    .bus_i(bus),
    .bus_o(out),
    .valid_o(output_valid)
  );
  always_comb assume (age != '0 || valid && ready);

  logic [7*Width-1:0] words;  // the test's words, in the order of arrival: Ix Iy Iz, a b c, d
  always_ff @(posedge clk) if (age < 4'd7) words[Width*age+:Width] <= bus;

  // ---- The expected component, from the test's words

  logic [4*Width-1:0] sums;
  logic [Width-1:0] numerator, quotient;

  assign sums[0+:Width] = '0;
  for (genvar k = 0; k < 3; k++) begin : gen_product
    logic [Width-1:0] product;
    fp_multiplier #(.ConstantRow(1'b1)) u_multiply (
      .clk_i(clk), .a_i(words[Width*(3+k)+:Width]), .b_i(words[Width*k+:Width]),
      .rounding_mode_i(3'd0), .tininess_after_i(1'b1), .result_o(product));
    fp_adder u_add (
      .clk_i(clk), .a_i(sums[Width*k+:Width]), .b_i(product), .subtract_i(1'b0),
      .rounding_mode_i(3'd0), .tininess_after_i(1'b1), .result_o(sums[Width*(k+1)+:Width]));
  end
  fp_multiplier #(.ConstantRow(1'b1)) u_numerator (
    .clk_i(clk), .a_i(words[Width*6+:Width]), .b_i(words[Width*(age-8)+:Width]),
    .rounding_mode_i(3'd0), .tininess_after_i(1'b1), .result_o(numerator));
  fp_divider u_divide (
    .clk_i(clk), .valid_i(1'b1), .a_i(numerator), .b_i(sums[3*Width+:Width]),
    .rounding_mode_i(3'd0), .tininess_after_i(1'b1), .result_o(quotient));

  always_comb begin
    if (age >= 4'd8 && age <= 4'd10) assert (output_valid && out == quotient);
    cover (age == 4'd10);
  end

endmodule
