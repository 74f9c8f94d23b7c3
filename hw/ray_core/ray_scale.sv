// Scale of a ray in a node: how far it may go there, 2**E, and a cap of 1 / I_k where planes are too far apart.
// Combinational. Steps 1 and 3 of box_unit's header say why. An exponent is binary32's, with its bias.
//
// In:  distances_i  exponents of D_k = origin_k - O_k, eight bits an axis, x lowest
//      inverse_i    1 / I_k, binary32, x lowest
//      cells_i      the grid's exponents e_k, eight bits an axis
//      t_max_i      t_max's exponent
// Out: exponent_o   E, at least -100
//      inverse_o    1 / I_k, or 2**(E + 2 - e_k), with its sign, where s_k is above 2**(E + 2)
//      caps_o       the exponent of that power of two, 11 signed bits an axis
//      is_capped_o  it is given
//      is_open_o    it is not a binary32 number: the axis says nothing
module ray_scale (
  input  logic [23:0] distances_i,
  input  logic [95:0] inverse_i,
  input  logic [23:0] cells_i,
  input  logic [7:0]  t_max_i,
  output logic [8:0]  exponent_o,
  output logic [95:0] inverse_o,
  output logic [32:0] caps_o,
  output logic [2:0]  is_capped_o,
  output logic [2:0]  is_open_o
);

  localparam logic signed [10:0] NoExponent = 11'sd511;
  localparam logic signed [10:0] LeastExponent = 11'sd27;

  logic signed [10:0] least, exponent;
  logic [32:0] reaches;  // 11 bits an axis

  for (genvar k = 0; k < 3; k++) begin : gen_axis
    logic [7:0] distance_field, inverse_field, cell_field;
    logic signed [10:0] beyond, grid, reach, cap;
    assign distance_field = distances_i[8*k +: 8];
    assign inverse_field  = inverse_i[32*k+23 +: 8];
    assign cell_field     = cells_i[8*k +: 8];
    assign beyond = $signed({3'b0, distance_field}) + 11'sd1;
    assign grid   = $signed({3'b0, cell_field}) + 11'sd8;
    assign reach  = ((beyond > grid) ? beyond : grid) + $signed({3'b0, inverse_field}) - 11'sd125;
    assign reaches[11*k +: 11] = (&inverse_field) ? NoExponent : reach;

    assign cap = exponent - $signed({3'b0, cell_field}) + 11'sd129;
    assign caps_o[11*k +: 11] = cap;
    assign is_capped_o[k] = (&inverse_field) | ($signed({3'b0, inverse_field}) >= cap);
    assign is_open_o[k] = is_capped_o[k] & (cap < 11'sd1 | cap > 11'sd254);
    assign inverse_o[32*k +: 32] =
        is_capped_o[k] ? {inverse_i[32*k+31], cap[7:0], 23'd0} : inverse_i[32*k +: 32];
  end

  always_comb begin
    least = (&t_max_i) ? NoExponent : $signed({3'b0, t_max_i}) + 11'sd1;
    for (int unsigned k = 0; k < 3; k++) begin
      if ($signed(reaches[11*k+:11]) < least) least = $signed(reaches[11*k+:11]);
    end
    exponent = (least < LeastExponent) ? LeastExponent : least;
  end
  assign exponent_o = exponent[8:0];

endmodule
