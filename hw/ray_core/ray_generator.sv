// Generator of camera rays: a rectangle of pixels, row by row. The paper's equation 1.
//
// The direction through pixel (x, y) is (first + y down) + x right, binary32, each operation rounded to nearest: first
// is the direction through pixel (0, 0), right and down are the steps to the next column and row. The direction is then
// scaled by a power of two, so that the largest component is in [1, 2). A component that becomes smaller than 2**-126
// is zero. The core refuses a direction that cannot be scaled: zero or not finite. Vectors are three words, x lowest.
//
// start_i, while not busy_o, takes the rectangle; a width or height of zero gives no ray. stop_i: no further pixel is
// begun. Throughput: a ray a clock.
module ray_generator #(
  parameter int unsigned Arith = arith_pkg::Graded
) (
  input  logic        clk_i,
  input  logic        rst_ni,
  // the camera; must not change while busy_o
  input  logic [95:0] first_i,
  input  logic [95:0] right_i,
  input  logic [95:0] down_i,
  // the rectangle
  input  logic        start_i,
  input  logic        stop_i,
  input  logic [15:0] x_i,
  input  logic [15:0] y_i,
  input  logic [15:0] width_i,
  input  logic [15:0] height_i,
  output logic        busy_o,  // there are rays to come
  // rays
  output logic        valid_o,
  input  logic        ready_i,
  output logic [95:0] direction_o,
  output logic [31:0] pixel_o  // {y, x}
);

  localparam int unsigned Latency = 1 + hit_test_pkg::MultiplierLatency
                                  + 2 * hit_test_pkg::AdderLatency;

  // ---- Count pixels

  logic counting_q, go, space, last_of_row, last;
  logic [15:0] x_q, y_q, columns_q, rows_q, width_q, begin_q;  // columns_q: left in this row

  assign go          = counting_q & space;
  assign last_of_row = columns_q == 16'd1;
  assign last        = last_of_row & (rows_q == 16'd1);

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) counting_q <= 1'b0;
    else if (start_i && !busy_o) counting_q <= (width_i != '0) & (height_i != '0);
    else if (stop_i || (go && last)) counting_q <= 1'b0;
  end
  always_ff @(posedge clk_i) begin
    if (start_i && !busy_o) begin
      x_q       <= x_i;
      y_q       <= y_i;
      columns_q <= width_i;
      rows_q    <= height_i;
      width_q   <= width_i;
      begin_q   <= x_i;
    end else if (go) begin
      x_q       <= last_of_row ? begin_q : x_q + 1'b1;
      columns_q <= last_of_row ? width_q : columns_q - 1'b1;
      if (last_of_row) begin
        y_q    <= y_q + 1'b1;
        rows_q <= rows_q - 1'b1;
      end
    end
  end

  // ---- The pixel's numbers as binary32, exactly

  logic [31:0] number_q[2];  // x and y as binary32

  for (genvar n = 0; n < 2; n++) begin : gen_number
    logic [15:0] count, normalised;  // the highest bit only adds to the exponent
    logic [3:0] zeros;
    logic zero;
    logic [7:0] field;
    assign count = (n == 0) ? x_q : y_q;

    leading_zero_counter #(
      .Width(16)
    ) u_zeros (
      .a_i(count),
      .count_o(zeros),
      .zero_o(zero)
    );
    assign normalised = count << zeros;
    assign field      = 8'd141 - 8'(zeros) + 8'(normalised[15]);

    always_ff @(posedge clk_i) begin
      number_q[n] <= {1'b0, zero ? 8'd0 : field, normalised[14:0], 8'd0};
    end
  end

  // ---- first + y down, then + x right

  logic [191:0] products;  // x right, y down
  logic [95:0] right_product, row_first, direction;

  for (genvar n = 0; n < 2; n++) begin : gen_product
    fp_vector #(
      .Multiply(1'b1),
      .Arith(Arith)
    ) u_scale (
      .clk_i,
      .step_i(1'b1),
      .a_i((n == 0) ? right_i : down_i),
      .b_i({3{number_q[n]}}),
      .result_o(products[96*n +: 96])
    );
  end
  fp_vector #(
    .Arith(Arith)
  ) u_row (
    .clk_i,
    .step_i(1'b1),
    .a_i(first_i),
    .b_i(products[96 +: 96]),
    .result_o(row_first)
  );
  delay_line #(
    .Width(96),
    .Depth(hit_test_pkg::AdderLatency)
  ) u_sideband_row (
    .clk_i,
    .enable_i(1'b1),
    .data_i(products[0 +: 96]),
    .data_o(right_product)
  );
  fp_vector #(
    .Arith(Arith)
  ) u_direction (
    .clk_i,
    .step_i(1'b1),
    .a_i(row_first),
    .b_i(right_product),
    .result_o(direction)
  );

  // ---- Scale: only exponents change

  logic [7:0] largest, unit;
  logic [95:0] scaled;

  always_comb begin
    largest = '0;
    for (int unsigned k = 0; k < 3; k++) begin
      if (direction[32*k+23+:8] > largest) largest = direction[32*k+23+:8];
    end
  end
  assign unit = (largest == 8'd255) ? 8'd255 : 8'd127;
  for (genvar k = 0; k < 3; k++) begin : gen_scaled
    logic [7:0] below;  // difference to the largest exponent
    assign below = largest - direction[32*k+23 +: 8];
    assign scaled[32*k +: 32] = ((direction[32*k+23 +: 8] == '0) | (below > 8'd126))
        ? {direction[32*k+31], 31'd0} : {direction[32*k+31], unit - below, direction[32*k +: 23]};
  end

  // ---- Rays in the pipeline, and waiting rays

  logic [Latency:0] valid_q;  // the last: a ray entered the queue in the clock before
  logic [31:0] pixel;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) valid_q <= '0;
    else valid_q <= {valid_q[Latency-1:0], go};
  end
  delay_line #(
    .Width(32),
    .Depth(Latency)
  ) u_pixel (
    .clk_i,
    .enable_i(1'b1),
    .data_i({y_q, x_q}),
    .data_o(pixel)
  );
  fifo #(
    .Width(96 + 32),
    .Depth(2 * Latency),
    .Reserve(Latency),
    .Memory(1'b1)
  ) u_rays (
    .clk_i,
    .rst_ni,
    .push_i(valid_q[Latency-1]),
    .data_i({scaled, pixel}),
    .space_o(space),
    .pop_i(valid_o & ready_i),
    .valid_o,
    .data_o({direction_o, pixel_o})
  );

  assign busy_o = counting_q | (valid_q != '0) | valid_o;

endmodule
