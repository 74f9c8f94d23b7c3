// Shifts a word right; lost_o is high if a 1 is lost. Combinational. An amount of Width or more shifts out all bits.
module sticky_right_shift #(
  parameter int unsigned Width = 26,
  parameter int unsigned AmountWidth = 8
) (
  input  logic [Width-1:0]       a_i,
  input  logic [AmountWidth-1:0] amount_i,
  output logic [Width-1:0]       shifted_o,
  output logic                   lost_o
);

  localparam int unsigned ShiftWidth = $clog2(Width + 1);
  logic [ShiftWidth-1:0] amount;

  if (AmountWidth > ShiftWidth) begin : gen_far
    assign amount = amount_i[ShiftWidth-1:0] | {ShiftWidth{|amount_i[AmountWidth-1:ShiftWidth]}};
  end else begin : gen_near
    assign amount = ShiftWidth'(amount_i);
  end
  assign shifted_o = a_i >> amount;
  assign lost_o = |(a_i & ~({Width{1'b1}} << amount));

endmodule
