// Claims about hit_decision. Assumption: a computed edge product u with |u| above its bound has the sign of the exact
// product. Exactly one of miss, hit and doubt is given. For a hit, all three exact products have the sign of d: the ray
// meets the triangle in its forward direction. V is then a normal number with the sign of d, and t_error is large
// enough for V. For a miss, d = 0, or an exact product has the sign opposite to d, or d is a NaN and two exact products
// have opposite signs. The exact products are modelled by three arbitrary signs; a product of 0 has neither sign.
module decision_follows_edges #(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input logic [Width-1:0]    d,
  input logic [ExpWidth-1:0] normal_exponent,
  input logic [Width-1:0]    v,
  input logic [3*Width-1:0]  u,
  input logic [3*Width-1:0]  bounds,
  input logic [2:0]          exact_positive,
  input logic [2:0]          exact_negative
);

  logic miss, hit, doubt;
  logic [3:0] t_error;

  hit_decision #(
    .ExpWidth(ExpWidth),
    .FracWidth(FracWidth)
  ) dut (
    .d_i(d),
    .normal_exponent_i(normal_exponent),
    .v_i(v),
    .u_i(u),
    .bounds_i(bounds),
    .miss_o(miss),
    .hit_o(hit),
    .doubt_o(doubt),
    .t_error_o(t_error)
  );

  localparam logic [Width-2:0] Infinity = {{ExpWidth{1'b1}}, {FracWidth{1'b0}}};

  // Magnitudes are compared as integers: words without their sign bits have the order of their values
  always_comb begin
    for (int unsigned k = 0; k < 3; k++) begin
      assume (!(exact_positive[k] && exact_negative[k]));
      if (!bounds[Width*k+Width-1] && bounds[Width*k+:Width-1] <= Infinity
          && u[Width*k+:Width-1] > bounds[Width*k+:Width-1]
          && u[Width*k+:Width-1] < Infinity) begin
        assume (u[Width*k+Width-1] ? exact_negative[k] : exact_positive[k]);
      end
      // Bounds are neither NaN nor negative
      assume (!bounds[Width*k+Width-1] && bounds[Width*k+:Width-1] <= Infinity);
    end
  end

  logic [2:0] on_side, on_other_side;
  assign on_side = d[Width-1] ? exact_negative : exact_positive;
  assign on_other_side = d[Width-1] ? exact_positive : exact_negative;

  logic d_nan;
  assign d_nan = d[Width-2:0] > Infinity;

  logic [ExpWidth-1:0] v_exponent;
  assign v_exponent = v[FracWidth+:ExpWidth];

  always_comb begin
    assert ({1'b0, miss} + {1'b0, hit} + {1'b0, doubt} == 2'd1 && !(miss && hit));
    if (hit) begin
      assert (on_side == '1 && d[Width-2:0] != '0 && !d_nan);
      assert (v[Width-1] == d[Width-1] && v_exponent != '0 && v_exponent != '1);
      assert (t_error <= 4'(hit_test_pkg::max_grazing(FracWidth)));
      assert ((ExpWidth + 1)'(normal_exponent) <= (ExpWidth + 1)'(v_exponent) + t_error);
    end
    if (miss) assert (d[Width-2:0] == '0 || (on_other_side != '0 && (!d_nan || on_side != '0)));
    cover (hit && t_error == 4'(hit_test_pkg::max_grazing(FracWidth)));
    cover (miss && d[Width-2:0] != '0);
    cover (miss && d_nan);
    cover (doubt && d[Width-2:0] != '0 && on_side == '1);
  end

endmodule
