// Scale of a ray in a node: 2**E, a bound of t there, and caps of 1 / I_k that limit the distance between planes.
// Latency: 2 clocks: registers after the bound of t of each axis and after E. All inputs come in the same clock. Steps
// 1 and 3 of the proof in box_unit's header derive the formulas. Exponents have binary32's bias.
//
// In:  distances_i  exponents of D_k = origin_k - O_k, eight bits per axis, x lowest
//      inverse_i    1 / I_k, binary32, x lowest
//      cells_i      the grid's exponents e_k, eight bits per axis
//      t_max_i      t_max's exponent
// Out: scale_o      see ray_core_pkg; E is at least -100
module ray_scale
  import ray_core_pkg::*;
(
  input  logic        clk_i,
  input  logic [23:0] distances_i,
  input  logic [95:0] inverse_i,
  input  logic [23:0] cells_i,
  input  logic [7:0]  t_max_i,
  output scale_t      scale_o
);

  localparam logic signed [10:0] NoExponent = 11'sd511;
  localparam logic signed [10:0] LeastExponent = 11'sd27;

  function automatic logic signed [10:0] smaller(logic signed [10:0] a, logic signed [10:0] b);
    smaller = (a < b) ? a : b;
  endfunction

  // ---- Reach: the exponent of the bound of t that each axis gives

  logic signed [10:0] t_max_q;
  logic [95:0] reach_inverse_q, inverse_q;
  logic [23:0] reach_cells_q;

  for (genvar k = 0; k < 3; k++) begin : gen_reach
    logic [7:0] inverse_field;
    logic signed [10:0] beyond, grid, rest, reach_q;
    assign inverse_field = inverse_i[32*k+23 +: 8];
    assign beyond = $signed({3'b0, distances_i[8*k +: 8]}) + 11'sd1;
    assign grid   = $signed({3'b0, cells_i[8*k +: 8]}) + 11'sd8;
    assign rest   = $signed({3'b0, inverse_field}) - 11'sd125;

    always_ff @(posedge clk_i) begin
      reach_q <= (&inverse_field) ? NoExponent : ((beyond > grid) ? beyond : grid) + rest;
    end
  end
  always_ff @(posedge clk_i) begin
    t_max_q         <= (&t_max_i) ? NoExponent : $signed({3'b0, t_max_i}) + 11'sd1;
    reach_inverse_q <= inverse_i;
    reach_cells_q   <= cells_i;
  end

  // ---- E

  logic signed [10:0] least, exponent_q;

  assign least = smaller(
    smaller(gen_reach[0].reach_q, gen_reach[1].reach_q), smaller(gen_reach[2].reach_q, t_max_q)
  );

  always_ff @(posedge clk_i) begin
    exponent_q <= (least < LeastExponent) ? LeastExponent : least;
    inverse_q  <= reach_inverse_q;
  end
  assign scale_o.exponent = exponent_q[8:0];

  // ---- Caps

  for (genvar k = 0; k < 3; k++) begin : gen_cap
    logic [7:0] inverse_field;
    logic signed [10:0] rest_q, cap;
    logic is_capped;

    always_ff @(posedge clk_i) rest_q <= 11'sd129 - $signed({3'b0, reach_cells_q[8*k+:8]});

    assign inverse_field = inverse_q[32*k+23+:8];
    assign cap           = exponent_q + rest_q;
    assign is_capped     = (&inverse_field) | ($signed({3'b0, inverse_field}) >= cap);
    assign scale_o.caps[11*k +: 11] = cap;
    assign scale_o.is_capped[k] = is_capped;
    assign scale_o.is_open[k]   = is_capped & (cap < 11'sd1 | cap > 11'sd254);
    assign scale_o.inverse[32*k +: 32] =
        is_capped ? {inverse_q[32*k+31], cap[7:0], 23'd0} : inverse_q[32*k +: 32];
  end

endmodule
