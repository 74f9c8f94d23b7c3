// A multiplexer with a constant select, as in the lowest group of a carry-select adder, becomes a wire.
module MULTIPLEXER (input WHEN_0, input WHEN_1, input SELECT, output OUT);
  parameter _TECHMAP_CONSTMSK_SELECT_ = 1'b0;
  parameter _TECHMAP_CONSTVAL_SELECT_ = 1'bx;
  wire _TECHMAP_FAIL_ = !_TECHMAP_CONSTMSK_SELECT_;
  assign OUT = _TECHMAP_CONSTVAL_SELECT_ ? WHEN_1 : WHEN_0;
endmodule

// A bit of a carry-save adder with a constant input becomes gates; any other bit becomes a full adder.
module CARRY_SAVE (input A, input B, input C, output SUM, output CARRY);
  parameter _TECHMAP_CONSTMSK_A_ = 1'b0;
  parameter _TECHMAP_CONSTMSK_B_ = 1'b0;
  parameter _TECHMAP_CONSTMSK_C_ = 1'b0;
  generate
    if (_TECHMAP_CONSTMSK_A_ || _TECHMAP_CONSTMSK_B_ || _TECHMAP_CONSTMSK_C_) begin
      assign SUM = A ^ B ^ C;
      assign CARRY = (A & B) | (C & (A ^ B));
    end else begin
      FULL_ADDER _TECHMAP_REPLACE_ (.A(A), .B(B), .C(C), .SUM(SUM), .CARRY(CARRY));
    end
  endgenerate
endmodule
