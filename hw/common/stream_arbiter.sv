// Joins streams: words of several valid/ready ports leave by one, each port in its turn.
//
// Combinational from a port to the output.
//
// What is offered stays until it is taken. source_o is the port it came from.
module stream_arbiter #(
  parameter int unsigned Width   = 32,
  parameter int unsigned Streams = 2,  // at least 2
  localparam int unsigned IndexWidth = $clog2(Streams)
) (
  input  logic                     clk_i,
  input  logic                     rst_ni,
  input  logic [Streams-1:0]       valid_i,
  output logic [Streams-1:0]       ready_o,
  input  logic [Streams*Width-1:0] data_i,  // port 0 lowest
  output logic                     valid_o,
  input  logic                     ready_i,
  output logic [Width-1:0]         data_o,
  output logic [IndexWidth-1:0]    source_o
);

  logic [IndexWidth-1:0] first_q;  // whose turn it is

  rr_arbiter #(
    .Width(Streams)
  ) u_pick (
    .requests_i(valid_i),
    .start_i(first_q),
    .valid_o,
    .index_o(source_o)
  );

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) first_q <= '0;
    else if (valid_o) first_q <= ready_i ? source_o + 1'b1 : source_o;
  end

  always_comb begin
    data_o  = '0;
    ready_o = '0;
    for (int unsigned n = 0; n < Streams; n++) begin
      if (source_o == IndexWidth'(n)) begin
        data_o     = data_i[Width*n+:Width];
        ready_o[n] = ready_i;
      end
    end
  end

endmodule
