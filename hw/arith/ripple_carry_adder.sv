// Ripple-carry adder, a chain of full adders: {carry_o, sum_o} = a_i + b_i + carry_i. Combinational; Width full-adder
// delays. Any Width from 1.
module ripple_carry_adder #(
  parameter int unsigned Width = 48
) (
  input  logic [Width-1:0] a_i,
  input  logic [Width-1:0] b_i,
  input  logic             carry_i,
  output logic [Width-1:0] sum_o,
  output logic             carry_o
);

  // One carry signal per bit: tools would report a vector as a combinational loop.
  for (genvar i = 0; i < Width; i++) begin : gen_bit
    logic carry_in, carry_out;
    if (i == 0) begin : gen_first
      assign carry_in = carry_i;
    end else begin : gen_next
      assign carry_in = gen_bit[i-1].carry_out;
    end
    full_adder u_full_adder (
      .a_i    (a_i[i]),
      .b_i    (b_i[i]),
      .carry_i(carry_in),
      .sum_o  (sum_o[i]),
      .carry_o(carry_out)
    );
  end

  assign carry_o = gen_bit[Width-1].carry_out;

endmodule
