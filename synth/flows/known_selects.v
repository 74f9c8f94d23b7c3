// A multiplexer whose select is known (as in the lowest group of a carry-select adder) is a wire.
module MULTIPLEXER (input WHEN_0, input WHEN_1, input SELECT, output OUT);
  parameter _TECHMAP_CONSTMSK_SELECT_ = 1'b0;
  parameter _TECHMAP_CONSTVAL_SELECT_ = 1'bx;
  wire _TECHMAP_FAIL_ = !_TECHMAP_CONSTMSK_SELECT_;
  assign OUT = _TECHMAP_CONSTVAL_SELECT_ ? WHEN_1 : WHEN_0;
endmodule
