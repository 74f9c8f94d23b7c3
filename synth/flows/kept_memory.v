// A memory that is kept, and the bits of its ports: see kept_memories.v.
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

(* blackbox *)
module kept_output (
  output bit_o
);
endmodule
