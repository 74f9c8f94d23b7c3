// Write enables of a kept memory. Bits that are written together have one enable net after ABC, and get one pin here.
(* techmap_celltype = "kept_enables" *)
module one_pin_a_net #(
  parameter WIDTH = 1
) (
  input [WIDTH-1:0] bits_i
);

  parameter _TECHMAP_BITS_CONNMAP_ = 0;
  localparam Bits = _TECHMAP_BITS_CONNMAP_;
  parameter [WIDTH*_TECHMAP_BITS_CONNMAP_-1:0] _TECHMAP_CONNMAP_bits_i_ = 0;  // numbers of the nets

  genvar i;
  generate
    if (1) begin : _TECHMAP_REPLACE_
      for (i = 0; i < WIDTH; i = i + 1) begin : pin
        if (i == 0 || _TECHMAP_CONNMAP_bits_i_[Bits*i+:Bits] != _TECHMAP_CONNMAP_bits_i_[Bits*(i-1)+:Bits])
          kept_input u_bit (.bit_i(bits_i[i]));
      end
    end
  endgenerate

endmodule
