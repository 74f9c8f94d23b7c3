// Verdict of a test, hit, miss or doubt, from its dot products.
//
// A record has a plane, d = N . A, and three edge planes E_k with error bounds bound_k (see hit_test_pkg). I is the
// ray's direction. U_k = I . E_k, as computed, is sure if bound_k < |U_k| < infinity: its sign is then exact. The sign
// of d is exact; if d is NaN, it is unknown. If a ray hits, the exact V = I . N and U_k have the sign of d.
//   miss   d is 0; or a sure U_k has another sign than d; or d is NaN and two sure U_k have different signs
//   hit    all U_k are sure and have d's sign, and V is fit for a division: V is a normal number with d's sign, and its
//          exponent is at most max_grazing below the largest exponent of N's words
//   doubt  everything else
// Exactly one of miss_o, hit_o, doubt_o is high. A U_k that is NaN is never sure. Words are compared as integers.
//
// t_error_o: see hit_test_pkg; valid for a hit only. Combinational.
module hit_decision
  import hit_test_pkg::*;
#(
  parameter int unsigned ExpWidth  = 8,
  parameter int unsigned FracWidth = 23,
  localparam int unsigned Width = 1 + ExpWidth + FracWidth
) (
  input  logic [Width-1:0]       d_i,
  input  logic [ExpWidth-1:0]    normal_exponent_i,  // largest exponent field of N's words
  input  logic [Width-1:0]       v_i,
  input  logic [3*Width-1:0]     u_i,
  input  logic [3*Width-1:0]     bounds_i,
  output logic                   miss_o,
  output logic                   hit_o,
  output logic                   doubt_o,
  output logic [TErrorWidth-1:0] t_error_o
);

  if (FracWidth < 7 || FracWidth > 26) begin : gen_check
    $error("hit_decision: expected a FracWidth of 7 to 26, for which t's bound is derived");
  end

  localparam int unsigned MaxGrazing = max_grazing(FracWidth);
  localparam logic [Width-2:0] Infinity = {{ExpWidth{1'b1}}, {FracWidth{1'b0}}};

  logic sign, d_zero, d_nan;
  assign sign   = d_i[Width-1];
  assign d_zero = d_i[Width-2:0] == '0;
  assign d_nan  = d_i[Width-2:0] > Infinity;

  // ---- The edges

  logic [2:0] sure, agrees;

  for (genvar k = 0; k < 3; k++) begin : gen_edge
    logic [Width-2:0] magnitude;
    assign magnitude = u_i[Width*k +: Width-1];
    assign sure[k]   = ({1'b0, magnitude} > bounds_i[Width*k +: Width]) & (magnitude < Infinity);
    assign agrees[k] = u_i[Width*k+Width-1] == sign;
  end

  // ---- The plane

  logic [ExpWidth-1:0] v_exponent;
  logic [ExpWidth:0] grazing;  // difference of exponents, modulo 2**(ExpWidth+1)
  logic grazing_negative, v_good;

  assign v_exponent       = v_i[FracWidth +: ExpWidth];
  assign grazing          = {1'b0, normal_exponent_i} - {1'b0, v_exponent};
  assign grazing_negative = grazing[ExpWidth];
  assign v_good = (v_i[Width-1] == sign) & (v_exponent != '0) & ~(&v_exponent)
                & (grazing_negative | (grazing <= (ExpWidth + 1)'(MaxGrazing)));
  assign t_error_o = grazing_negative ? '0 : TErrorWidth'(grazing);

  // ---- The verdict

  assign miss_o  = d_zero | ((|(sure & ~agrees)) & (~d_nan | (|(sure & agrees))));
  assign hit_o   = ~d_zero & ~d_nan & (&(sure & agrees)) & v_good;
  assign doubt_o = ~miss_o & ~hit_o;

endmodule
