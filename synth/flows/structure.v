// Stands in for hw/arith/full_adder.sv and multiplexer.sv where the paper's structure is to be kept:
// each full adder and each bit of a multiplexer becomes one cell that no tool looks into.
(* blackbox *)
module FULL_ADDER (input A, input B, input C, output SUM, output CARRY);
endmodule

(* blackbox *)
module MULTIPLEXER (input WHEN_0, input WHEN_1, input SELECT, output OUT);
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
