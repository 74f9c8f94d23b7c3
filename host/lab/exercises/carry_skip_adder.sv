// Carry-skip adder: {carry_o, sum_o} = a_i + b_i + carry_i. Groups of Group bits ripple; a carry skips a group whose every bit
// would hand it on. Combinational; any Width from 1.
// Source: M. Lehman and N. Burla, "Skip techniques for high-speed carry-propagation in binary arithmetic units", IRE Trans.
// EC-10, 1961.
module carry_skip_adder #(
  parameter int unsigned Width = 48,
  parameter int unsigned Group = 6
) (
  input  logic [Width-1:0] a_i,
  input  logic [Width-1:0] b_i,
  input  logic             carry_i,
  output logic [Width-1:0] sum_o,
  output logic             carry_o
);

  localparam int unsigned Groups = (Width + Group - 1) / Group;

  // One carry signal per group: a vector would feed itself.
  for (genvar g = 0; g < Groups; g++) begin : gen_group
    localparam int unsigned Low = Group * g;
    localparam int unsigned Size = (Width - Low < Group) ? Width - Low : Group;

    logic carry_in, carry_ripple, carry_out, skip;

    if (g == 0) begin : gen_first
      assign carry_in = carry_i;
    end else begin : gen_next
      assign carry_in = gen_group[g-1].carry_out;
    end

    ripple_carry_adder #(
      .Width(Size)
    ) u_ripple (
      .a_i    (a_i[Low+:Size]),
      .b_i    (b_i[Low+:Size]),
      .carry_i(carry_in),
      .sum_o  (sum_o[Low+:Size]),
      .carry_o(carry_ripple)
    );

    assign skip = &(a_i[Low+:Size] ^ b_i[Low+:Size]);
    assign carry_out = skip ? carry_in : carry_ripple;
  end

  assign carry_o = gen_group[Groups-1].carry_out;

endmodule
