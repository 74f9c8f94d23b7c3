// The parts of the hit-test units, each by itself.
module parts_top (
  input  logic         clk_i,
  input  logic         rst_ni,
  input  logic         valid_i,
  // vec_scale, fp_add3, point_unit: five words and a factor
  input  logic [159:0] words_i,
  input  logic [31:0]  factor_i,
  output logic [159:0] products_o,
  output logic [31:0]  sum_o,
  output logic         point_valid_o,
  output logic [95:0]  point_o,        // words 0 to 2 by the factor
  // hit_decision
  input  logic [31:0]  d_i,
  input  logic [7:0]   normal_exponent_i,
  input  logic [31:0]  v_i,
  input  logic [95:0]  u_i,
  input  logic [95:0]  bounds_i,
  output logic [2:0]   verdict_o,      // miss, hit, doubt
  output logic [3:0]   t_error_o,
  // hit_test_control with 7 words and 3 steps, and with 10 and 5
  output logic [1:0]   control_ready_o,
  output logic [7:0]   word_o,
  output logic [7:0]   step_o,
  // nearest_hit
  input  logic         first_i,
  input  logic         last_i,
  input  logic         hit_i,
  input  logic         doubt_i,
  input  logic [31:0]  tag_i,
  input  logic [31:0]  t_i,
  input  logic [3:0]   t_error_i,
  output logic         sure_hit_o,
  output logic [1:0]   report_o,
  output logic [31:0]  report_tag_o,
  output logic         closed_o,
  output logic         found_o,
  output logic [31:0]  nearest_tag_o,
  output logic [31:0]  nearest_t_o,
  output logic [3:0]   nearest_t_error_o,
  output logic [31:0]  payload_o
);

  vec_scale #(.Arith(1)) u_scaler (.clk_i, .words_i, .factor_i, .products_o);
  fp_add3 #(.Arith(1)) u_sum (
    .clk_i, .x_i(words_i[31:0]), .y_i(words_i[63:32]), .z_i(words_i[95:64]), .sum_o);
  point_unit #(.Arith(1)) u_point (
    .clk_i, .rst_ni, .valid_i, .dividends_i(words_i[95:0]), .v_i(factor_i),
    .valid_o(point_valid_o), .point_o);
  hit_decision u_decision (
    .d_i, .normal_exponent_i, .v_i, .u_i, .bounds_i, .miss_o(verdict_o[2]), .hit_o(verdict_o[1]),
    .doubt_o(verdict_o[0]), .t_error_o);

  logic [2:0] word_7, step_5;
  logic [1:0] step_3;
  logic [3:0] word_10;
  hit_test_control #(.NumWords(7), .NumSteps(3)) u_control_7 (
    .clk_i, .rst_ni, .valid_i, .ready_o(control_ready_o[0]), .word_o(word_7), .step_o(step_3));
  hit_test_control #(.NumWords(10), .NumSteps(5)) u_control_10 (
    .clk_i, .rst_ni, .valid_i, .ready_o(control_ready_o[1]), .word_o(word_10), .step_o(step_5));
  assign word_o = {word_10, 1'b0, word_7};
  assign step_o = {1'b0, step_5, 2'b00, step_3};

  hit_test_pkg::report_e report;
  nearest_hit #(.PayloadWidth(32)) u_nearest (
    .clk_i, .rst_ni, .valid_i, .first_i, .last_i, .hit_i, .doubt_i, .tag_i, .t_i,
    .t_error_i, .payload_i(~tag_i), .sure_hit_o, .report_o(report), .report_tag_o, .closed_o,
    .found_o, .tag_o(nearest_tag_o), .t_o(nearest_t_o), .t_error_o(nearest_t_error_o), .payload_o);
  assign report_o = report;

endmodule
