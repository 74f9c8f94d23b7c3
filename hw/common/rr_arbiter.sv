// Picks one of Width requests: the first at or above start_i, or else the first of all.
//
// Combinational. Width is a power of two, at least 2.
module rr_arbiter #(
  parameter int unsigned Width = 64,
  localparam int unsigned IndexWidth = $clog2(Width)
) (
  input  logic [Width-1:0]      requests_i,
  input  logic [IndexWidth-1:0] start_i,
  output logic                  valid_o,
  output logic [IndexWidth-1:0] index_o
);

  logic [Width-1:0] above, among, picked;

  assign above  = requests_i & ({Width{1'b1}} << start_i);
  assign among  = (above != '0) ? above : requests_i;
  assign picked = among & -among;  // its lowest bit
  assign valid_o = requests_i != '0;

  for (genvar b = 0; b < IndexWidth; b++) begin : gen_bit
    // The numbers with bit b.
    localparam logic [Width-1:0] Numbers = {(Width >> (b + 1)){{(1 << b){1'b1}}, {(1 << b){1'b0}}}};
    assign index_o[b] = (picked & Numbers) != '0;
  end

endmodule
