// Word-wide multiplexer with a select line of its own for every bit:
// out_o[i] = select_i[i] ? when_1_i[i] : when_0_i[i]. Combinational.
//
// Ordered = 1: the user guarantees that when_0_i[i] implies when_1_i[i]. (A group's carries do: a carry that is
// generated without a carry in is also generated with one.) AND-OR is then enough, without inverted select.
module multiplexer #(
  parameter int unsigned Width = 1,
  parameter bit Ordered = 1'b0
) (
  input  logic [Width-1:0] select_i,
  input  logic [Width-1:0] when_0_i,
  input  logic [Width-1:0] when_1_i,
  output logic [Width-1:0] out_o
);

  // Written as gates: C++ compilers turn `?:` into branches, which random data mispredict.
  if (Ordered) begin : gen_ordered
    assign out_o = when_0_i | (when_1_i & select_i);
  end else begin : gen_any
    assign out_o = (when_0_i & ~select_i) | (when_1_i & select_i);
  end

endmodule
