// Maps the cells of structure.v to the cells of the OSU libraries.
module FULL_ADDER (input A, input B, input C, output SUM, output CARRY);
  FAX1 _TECHMAP_REPLACE_ (.A(A), .B(B), .C(C), .YS(SUM), .YC(CARRY));
endmodule

// MUX2X1 inverts: Y = !(S ? A : B).
module MULTIPLEXER (input WHEN_0, input WHEN_1, input SELECT, output OUT);
  wire inverted;
  MUX2X1 select (.A(WHEN_1), .B(WHEN_0), .S(SELECT), .Y(inverted));
  INVX1 restore (.A(inverted), .Y(OUT));
endmodule
