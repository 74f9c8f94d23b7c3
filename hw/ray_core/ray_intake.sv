// Rays come in: a slot of the table for each, and the reciprocals of its direction.
//
// Throughput a ray a clock. A ray that is taken gets the free slot of the lowest number, slot_o in the clock
// of its taking; when its reciprocals have come, a division's latency later, start_valid_o offers it to the walk.
module ray_intake #(
  parameter int unsigned Rays  = 64,
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                clk_i,
  input  logic                rst_ni,
  input  logic                valid_i,
  output logic                ready_o,
  input  logic [95:0]         direction_i,
  output logic [RayWidth-1:0] slot_o,
  input  logic                free_valid_i,     // a slot is free again
  input  logic [RayWidth-1:0] free_slot_i,
  output logic                inverse_valid_o,  // a slot's reciprocals
  output logic [RayWidth-1:0] inverse_slot_o,
  output logic [95:0]         inverse_o,
  output logic                start_valid_o,    // a ray is complete
  output logic [RayWidth-1:0] start_slot_o,
  input  logic                start_taken_i
);

  localparam int unsigned DivideLatency = hit_test_pkg::divide_latency(23);
  localparam logic [31:0] One = 32'h3f80_0000;

  // ---- Slots

  logic [Rays-1:0] free_q;
  logic some_free, taken;

  rotating_pick #(
    .Width(Rays)
  ) u_pick (
    .requests_i(free_q),
    .start_i('0),
    .valid_o(some_free),
    .index_o(slot_o)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      free_q <= '1;
    end else begin
      if (taken) free_q[slot_o] <= 1'b0;
      if (free_valid_i) free_q[free_slot_i] <= 1'b1;
    end
  end

  // ---- Divide

  logic [DivideLatency-1:0] dividing_q;

  assign ready_o = rst_ni & some_free;
  assign taken   = valid_i & ready_o;

  for (genvar k = 0; k < 3; k++) begin : gen_word
    fp_pkg::flags_t unused_flags;

    fp_divider_stages #(
      .Arith(Arith),
      .Adder(Adder),
      .Cuts(hit_test_pkg::DividerCuts)
    ) u_divider (
      .clk_i,
      .valid_i(taken),
      .a_i(One),
      .b_i(direction_i[32*k +: 32]),
      .rounding_mode_i(fp_pkg::RoundNearestEven),
      .tininess_after_i(1'b0),
      .result_o(inverse_o[32*k +: 32]),
      .flags_o(unused_flags)
    );
  end

  delay_line #(
    .Width(RayWidth),
    .Depth(DivideLatency)
  ) u_beside (
    .clk_i,
    .enable_i(1'b1),
    .data_i(slot_o),
    .data_o(inverse_slot_o)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) dividing_q <= '0;
    else dividing_q <= {dividing_q[DivideLatency-2:0], taken};
  end
  assign inverse_valid_o = dividing_q[DivideLatency-1];

  // ---- Rays that are complete

  logic unused_space;

  fifo #(
    .Width(RayWidth),
    .Depth(Rays)
  ) u_complete (
    .clk_i,
    .rst_ni,
    .push_i(inverse_valid_o),
    .data_i(inverse_slot_o),
    .space_o(unused_space),
    .pop_i(start_taken_i),
    .valid_o(start_valid_o),
    .data_o(start_slot_o)
  );

endmodule
