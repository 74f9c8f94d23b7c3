// Claims, for any functions that the pipelined unit's float cores compute: V and U_k are sums (x + y) + z of the
// products of the record's words and the direction's components. The verdict is that of hit_decision for V and U_k.
// Also, t = d / V, and for a nearest hit P_k = (d I_k) / V. The proof computes these words combinationally. After the
// unit's latency, it compares them with P and with the words that enter nearest_hit. opened_hit_test_pipeline is the
// unit with these words as outputs. Proof pipeline_keeps_tags: tests enter nearest_hit once, in order, with their tags.
module pipeline_computes #(
  parameter int unsigned ExpWidth  = 5,
  parameter int unsigned FracWidth = 10,
  localparam int unsigned Width       = 1 + ExpWidth + FracWidth,
  localparam int unsigned RecordWidth = hit_test_pkg::RecordWords * Width,
  localparam int unsigned TErrorWidth = hit_test_pkg::TErrorWidth
) (
  input logic                   clk,
  input logic                   reset_n,
  input logic                   valid,
  input logic                   first,
  input logic                   last,
  input logic                   tag,
  input logic [3*Width-1:0]     direction_in,
  input logic [RecordWidth-1:0] record_in,
  input logic                   take
);

  localparam int unsigned DivideLatency = hit_test_pkg::divide_latency(FracWidth);
  // Clocks of the decision (1), the dot products and the division
  localparam int unsigned Latency = 1 + hit_test_pkg::DotLatency + DivideLatency;

  logic found, divided, hit, doubt, point_asked;
  logic [Width-1:0] t;
  logic [TErrorWidth-1:0] t_error;
  logic [4*Width-1:0] payload;
  logic [3*Width-1:0] dividends, point;
  logic [Width-1:0] divisor;

  opened_hit_test_pipeline dut (
    .clk_i(clk),
    .rst_ni(reset_n),
    .valid_i(valid),
    .first_i(first),
    .last_i(last),
    .tag_i(tag),
    .direction_i(direction_in),
    .record_i(record_in),
    .ready_i(take),
    .\u_nearest.valid_i (divided),
    .\u_nearest.hit_i (hit),
    .\u_nearest.doubt_i (doubt),
    .\u_nearest.t_i (t),
    .\u_nearest.t_error_i (t_error),
    .\u_nearest.payload_i (payload),
    .point_asked(point_asked),
    .nearest_payload({dividends, divisor}),
    .point_valid(found),
    .point(point)
  );

  // ---- The inputs of Latency clocks ago, and the words of the nearest hit for which P is computed

  logic [3*Width-1:0] direction, old_dividends;
  logic [RecordWidth-1:0] record;
  logic [Width-1:0] old_divisor;

  delay_line #(.Width(3 * Width + RecordWidth), .Depth(Latency)) u_words (
    .clk_i(clk), .enable_i(1'b1), .data_i({direction_in, record_in}), .data_o({direction, record}));
  delay_line #(.Width(4 * Width), .Depth(DivideLatency)) u_point_words (
    .clk_i(clk), .enable_i(1'b1), .data_i({dividends, divisor}),
    .data_o({old_dividends, old_divisor}));

  logic [Latency-1:0] clocks;  // number of clocks so far, in unary: inputs of clocks before the first are undefined
  initial clocks = '0;
  always_ff @(posedge clk) clocks <= {clocks[Latency-2:0], 1'b1};

  always_comb assume (clocks[0] || !reset_n);

  // ---- The expected results

  localparam int unsigned Normal = hit_test_pkg::RecordNormal;
  localparam int unsigned D = hit_test_pkg::RecordD;
  localparam int unsigned Edges = hit_test_pkg::RecordEdges;

  logic [4*Width-1:0] dots;  // V, U_0, U_1, U_2
  logic [3*Width-1:0] products_d;
  logic [Width-1:0] quotient;
  logic [3*Width-1:0] quotients;
  logic should_miss, should_hit, should_doubt;
  logic [TErrorWidth-1:0] should_t_error;

  for (genvar n = 0; n < 4; n++) begin : gen_dot
    localparam int unsigned Row = (n == 0) ? Normal : Edges + 3 * (n - 1);
    logic [3*Width-1:0] product;
    logic [Width-1:0] sum;
    for (genvar k = 0; k < 3; k++) begin : gen_product
      fp_multiplier #(.ExpWidth(ExpWidth), .FracWidth(FracWidth)) u_multiply (
        .clk_i(clk), .a_i(record[Width*(Row+k)+:Width]), .b_i(direction[Width*k+:Width]),
        .rounding_mode_i(3'd0), .tininess_after_i(1'b0), .result_o(product[Width*k+:Width]));
    end
    fp_adder #(.ExpWidth(ExpWidth), .FracWidth(FracWidth)) u_add (
      .clk_i(clk), .a_i(product[0+:Width]), .b_i(product[Width+:Width]), .subtract_i(1'b0),
      .rounding_mode_i(3'd0), .tininess_after_i(1'b0), .result_o(sum));
    fp_adder #(.ExpWidth(ExpWidth), .FracWidth(FracWidth)) u_add_third (
      .clk_i(clk), .a_i(sum), .b_i(product[2*Width+:Width]), .subtract_i(1'b0),
      .rounding_mode_i(3'd0), .tininess_after_i(1'b0), .result_o(dots[Width*n+:Width]));
  end

  for (genvar k = 0; k < 3; k++) begin : gen_coordinate
    fp_multiplier #(.ExpWidth(ExpWidth), .FracWidth(FracWidth)) u_multiply (
      .clk_i(clk), .a_i(record[Width*D+:Width]), .b_i(direction[Width*k+:Width]),
      .rounding_mode_i(3'd0), .tininess_after_i(1'b0), .result_o(products_d[Width*k+:Width]));
    fp_divider #(.ExpWidth(ExpWidth), .FracWidth(FracWidth)) u_divide (
      .clk_i(clk), .valid_i(1'b1), .a_i(old_dividends[Width*k+:Width]), .b_i(old_divisor),
      .rounding_mode_i(3'd0), .tininess_after_i(1'b0), .result_o(quotients[Width*k+:Width]));
  end

  fp_divider #(.ExpWidth(ExpWidth), .FracWidth(FracWidth)) u_divide (
    .clk_i(clk), .valid_i(1'b1), .a_i(record[Width*D+:Width]), .b_i(dots[0+:Width]),
    .rounding_mode_i(3'd0), .tininess_after_i(1'b0), .result_o(quotient));

  logic [ExpWidth-1:0] exponent_x, exponent_y, exponent_z, largest;
  assign exponent_x = record[Width*Normal+FracWidth+:ExpWidth];
  assign exponent_y = record[Width*(Normal+1)+FracWidth+:ExpWidth];
  assign exponent_z = record[Width*(Normal+2)+FracWidth+:ExpWidth];
  always_comb begin
    largest = exponent_x;
    if (exponent_y > largest) largest = exponent_y;
    if (exponent_z > largest) largest = exponent_z;
  end

  hit_decision #(.ExpWidth(ExpWidth), .FracWidth(FracWidth)) u_decision (
    .d_i(record[Width*D+:Width]), .normal_exponent_i(largest), .v_i(dots[0+:Width]),
    .u_i(dots[Width+:3*Width]), .bounds_i(record[Width*hit_test_pkg::RecordBounds+:3*Width]),
    .miss_o(should_miss), .hit_o(should_hit), .doubt_o(should_doubt), .t_error_o(should_t_error));

  // ---- The claim

  always_comb begin
    if (clocks[Latency-1]) begin
      assert (payload == {products_d, dots[0+:Width]});
      assert ({hit, doubt, t_error} == {should_hit, should_doubt, should_t_error});
      if (divided && hit) assert (t == quotient);
      if (found) assert (point == quotients);
    end
    cover (divided && hit && clocks[Latency-1]);
    cover (point_asked);
  end

endmodule
