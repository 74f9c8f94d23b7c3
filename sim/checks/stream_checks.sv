// The rules of every valid/ready port: valid is low in reset. Once valid is high, valid and data hold until ready.
//
// The assertions are immediate assertions in clocked processes, not concurrent ones. Verilator samples concurrent
// assertions too early: before inputs that change together with the clock edge have settled.
module stream_checks #(
  parameter int unsigned Width = 1
) (
  input logic             clk_i,
  input logic             rst_ni,
  input logic             valid,
  input logic             ready,
  input logic [Width-1:0] data
);

  logic waiting_q;  // valid was high and ready low
  logic [Width-1:0] data_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) waiting_q <= 1'b0;
    else waiting_q <= valid && !ready;
  end
  always_ff @(posedge clk_i) if (valid && !ready) data_q <= data;

  always_ff @(posedge clk_i) begin
    a_quiet_in_reset : assert (rst_ni || !valid);
    a_valid_holds : assert (!rst_ni || !waiting_q || valid);
    if (waiting_q) a_data_holds : assert (!rst_ni || data == data_q);
  end

endmodule
