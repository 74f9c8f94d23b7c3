// Picks one of Width requests: the lowest at or above start_i, or else the lowest of all (0 if none). Combinational.
module rr_arbiter #(
  parameter int unsigned Width = 64,
  localparam int unsigned IndexWidth = $clog2(Width)
) (
  input  logic [Width-1:0]      requests_i,
  input  logic [IndexWidth-1:0] start_i,
  output logic                  valid_o,
  output logic [IndexWidth-1:0] index_o
);

  if (Width < 2) begin : gen_check
    $error("rr_arbiter: expected a Width of 2 or more");
  end

  logic [Width-1:0] above, among, picked;

  assign above  = requests_i & ({Width{1'b1}} << start_i);
  assign among  = (above != '0) ? above : requests_i;
  assign picked = among & -among;  // the lowest 1 of `among`
  assign valid_o = requests_i != '0;

  // Returns a mask of the indices whose bit b is 1
  function automatic bit [Width-1:0] numbers(int unsigned b);
    for (int unsigned i = 0; i < Width; i++) numbers[i] = ((i >> b) % 2) == 1;
  endfunction

  for (genvar b = 0; b < IndexWidth; b++) begin : gen_bit
    assign index_o[b] = (picked & numbers(b)) != '0;
  end

endmodule
