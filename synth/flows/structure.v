// Replaces hw/arith/full_adder.sv, multiplexer.sv and carry_save_adder.sv in flows that keep the
// paper's structure. Each full adder and each bit of a multiplexer or carry-save adder becomes one
// black-box cell, which tools do not optimise.
(* blackbox *)
module FULL_ADDER (input A, input B, input C, output SUM, output CARRY);
endmodule

(* blackbox *)
module MULTIPLEXER (input WHEN_0, input WHEN_1, input SELECT, output OUT);
endmodule

(* blackbox *)
module CARRY_SAVE (input A, input B, input C, output SUM, output CARRY);
endmodule

module full_adder (input a_i, input b_i, input carry_i, output sum_o, output carry_o);
  FULL_ADDER u_cell (.A(a_i), .B(b_i), .C(carry_i), .SUM(sum_o), .CARRY(carry_o));
endmodule

module multiplexer #(parameter Width = 1, parameter Ordered = 0) (
    input [Width-1:0] select_i,
    input [Width-1:0] when_0_i,
    input [Width-1:0] when_1_i,
    output [Width-1:0] out_o
);
  for (genvar i = 0; i < Width; i = i + 1) begin : gen_bit
    MULTIPLEXER u_cell (
        .WHEN_0(when_0_i[i]), .WHEN_1(when_1_i[i]), .SELECT(select_i[i]), .OUT(out_o[i]));
  end
endmodule

module carry_save_adder #(parameter Width = 1) (
    input [Width-1:0] a_i,
    input [Width-1:0] b_i,
    input [Width-1:0] c_i,
    output [Width-1:0] sum_o,
    output [Width-1:0] carry_o
);
  wire [Width-1:0] carry;
  for (genvar i = 0; i < Width; i = i + 1) begin : gen_bit
    CARRY_SAVE u_cell (
        .A(a_i[i]), .B(b_i[i]), .C(c_i[i]), .SUM(sum_o[i]), .CARRY(carry[i]));
  end
  assign carry_o = carry << 1;
endmodule
