// The exact unit never reads a digit that a step in flight has yet to write.
module exact_checks #(
  parameter int unsigned AddressWidth = 8
) (
  input logic                         clk_i,
  input logic                         rst_ni,
  input logic                         reads,      // two digits are read at this clock edge
  input logic [AddressWidth-1:0]      x_address,
  input logic [AddressWidth-1:0]      y_address,
  input logic [3:0]                   writes,     // bit k: the step in stage k + 1 will write a digit
  input logic [3:0][AddressWidth-1:0] addresses
);

  always_ff @(posedge clk_i) begin
    for (int unsigned k = 0; k < 4; k++) begin
      if (rst_ni && reads && writes[k]) begin
        a_x_is_written : assert (x_address != addresses[k]);
        a_y_is_written : assert (y_address != addresses[k]);
      end
    end
  end

endmodule
