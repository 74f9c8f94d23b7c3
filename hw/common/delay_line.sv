// Delay line: a word, Depth clocks later.
// Latency: Depth clocks with enable_i high. With Depth = 0, data_o is data_i. No reset: data_o is undefined at first.
module delay_line #(
  parameter int unsigned Width = 32,
  parameter int unsigned Depth = 1
) (
  input  logic             clk_i,
  input  logic             enable_i,
  input  logic [Width-1:0] data_i,
  output logic [Width-1:0] data_o
);

  if (Depth == 0) begin : gen_wire
    logic unused;
    assign unused = clk_i & enable_i;
    assign data_o = data_i;
  end else begin : gen_line
    for (genvar i = 0; i < Depth; i++) begin : gen_stage
      logic [Width-1:0] data_q;
      if (i == 0) begin : gen_first
        always_ff @(posedge clk_i) if (enable_i) data_q <= data_i;
      end else begin : gen_next
        always_ff @(posedge clk_i) if (enable_i) data_q <= gen_stage[i-1].data_q;
      end
    end
    assign data_o = gen_stage[Depth-1].data_q;
  end

endmodule
