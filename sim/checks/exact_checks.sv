// The exact unit reads no digit that a step in flight is still going to write.
module exact_checks #(
  parameter int unsigned AddressWidth = 8
) (
  input logic                         clk_i,
  input logic                         rst_ni,
  input logic                         reads,      // two digits, at this clock edge
  input logic [AddressWidth-1:0]      x_address,
  input logic [AddressWidth-1:0]      y_address,
  input logic [3:0]                   writes,     // the step in this stage is going to write a digit
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
