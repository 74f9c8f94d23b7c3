// Black boxes of a kept memory and of the bits of its ports: see kept_memories.v.
(* blackbox, keep *)
module kept_memory #(
  parameter BITS = 1
) ();
endmodule

(* blackbox, keep *)
module kept_input (
  input bit_i
);
endmodule

(* blackbox, keep *)
module kept_enables #(
  parameter WIDTH = 1
) (
  input [WIDTH-1:0] bits_i
);
endmodule

(* blackbox *)
module kept_output (
  output bit_o
);
endmodule
