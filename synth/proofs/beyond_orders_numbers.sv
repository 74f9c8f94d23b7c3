// Claim: is_beyond compares the numbers that its operands encode (here as integers, in units of 2**-149). Exponent 255
// counts as one more exponent of normal numbers: infinity, a t_max without limit, encodes 2**128, above every hit's t.
module beyond_orders_numbers #(
  localparam int unsigned EnterWidth = ray_core_pkg::EnterWidth,
  localparam int unsigned NumberWidth = 24 + 254
) (
  input logic [EnterWidth-1:0] enter,
  input logic [30:0]           t_max
);

  function automatic logic [NumberWidth-1:0] number(logic [30:0] word);
    number = (word[30:23] == '0) ? NumberWidth'(word[22:0])
                                 : NumberWidth'({1'b1, word[22:0]}) << (word[30:23] - 8'd1);
  endfunction

  always_comb begin
    assert (ray_core_pkg::is_beyond(enter, t_max)
            == (number(t_max) < number({enter, {31 - EnterWidth{1'b0}}})));
  end

endmodule
