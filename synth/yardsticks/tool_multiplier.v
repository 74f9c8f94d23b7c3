// What the synthesis tool makes of `*`: the yardstick of the Booth multiplier.
module tool_multiplier #(
    parameter Width = 24
) (
    input  [Width-1:0] a_i,
    input  [Width-1:0] b_i,
    output [2*Width-1:0] product_o
);
  assign product_o = a_i * b_i;
endmodule
