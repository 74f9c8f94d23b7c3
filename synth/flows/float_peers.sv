// Wrappers of this project's and other projects' binary32 cores with the same ports, for synth/float_peers.py.
//
// An operation begins in each clock with valid_i and ready_o. Results come with valid_o, in order. Rounding modes and
// flags are encoded as in RISC-V (fp_pkg). HardFloat uses a format of its own ("recoded", 33 bits); the wrapper
// converts operands and results. The other projects' adders and multipliers are fused multiply-add cores with a factor
// of 1 or an addend of 0. Mapping removes the gates that these constants make redundant.

`define FLOAT_PEER_PORTS \
  input logic clk_i, rst_ni, valid_i, input logic [31:0] a_i, b_i, input logic [2:0] rounding_mode_i, \
  output logic ready_o, valid_o, output logic [31:0] result_o, output logic [4:0] flags_o

package float_peers_pkg;

  // Converts IEEE binary32 to HardFloat's recoded format.
  function automatic logic [32:0] recoded(logic [31:0] bits);
    logic [8:0]  exponent;
    logic [22:0] fraction;
    logic [4:0]  zeros;
    zeros = 5'd22;
    for (int k = 0; k < 23; k++) if (bits[k]) zeros = 5'(22 - k);
    fraction = bits[30:23] == '0 ? 23'({bits[21:0], 1'b0} << zeros) : bits[22:0];
    exponent = bits[30:23] == '0 ? ~{4'b0, zeros} + 9'h82 : {1'b0, bits[30:23]} + 9'h81;
    if (bits[30:0] == '0) exponent[8:6] = '0;
    else if (exponent[8:7] == 2'b11) exponent[6] = bits[22:0] != '0;  // NaN
    return {bits[31], exponent, fraction};
  endfunction

  // Converts HardFloat's recoded format to IEEE binary32.
  function automatic logic [31:0] decoded(logic [32:0] bits);
    logic [8:0]  exponent = bits[31:23];
    logic        is_special = exponent[8:7] == 2'b11, is_zero = exponent[8:6] == '0;
    logic [22:0] subnormal = 23'({!is_zero, bits[22:0]} >> 5'(9'd130 - exponent));
    if (is_special) return {bits[32], 8'hff, exponent[6] ? bits[22:0] : 23'b0};
    if (exponent < 9'd130) return {bits[32], 8'b0, is_zero ? 23'b0 : subnormal};
    return {bits[32], 8'(exponent - 9'd129), bits[22:0]};
  endfunction

endpackage

module our_add (`FLOAT_PEER_PORTS);
  assign {ready_o, valid_o} = {1'b1, valid_i};
  fp_adder u_core (.a_i, .b_i, .subtract_i(1'b0), .rounding_mode_i, .tininess_after_i(1'b1), .result_o, .flags_o);
endmodule

module our_multiply (`FLOAT_PEER_PORTS);
  assign {ready_o, valid_o} = {1'b1, valid_i};
  fp_multiplier u_core (.a_i, .b_i, .rounding_mode_i, .tininess_after_i(1'b1), .result_o, .flags_o);
endmodule

module our_divide (`FLOAT_PEER_PORTS);
  assign {ready_o, valid_o} = {1'b1, valid_i};
  fp_divider u_core (.a_i, .b_i, .rounding_mode_i, .tininess_after_i(1'b1), .result_o, .flags_o);
endmodule

module hardfloat_multiply_add #(
  parameter int unsigned Does = 0  // 0: a * b, 1: a + b, 2: a * b + c
) (`FLOAT_PEER_PORTS, input logic [31:0] c_i);
  logic        valid_q, valid_qq;
  logic [32:0] result;
  logic [31:0] zero;
  assign zero = {a_i[31] ^ b_i[31], 31'b0};
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) {valid_qq, valid_q} <= '0;
    else {valid_qq, valid_q} <= {valid_q, valid_i};
  end
  assign {ready_o, valid_o, result_o} = {1'b1, valid_qq, float_peers_pkg::decoded(result)};
  MulAddRecFNPipe u_core (
    .clock(clk_i), .reset(!rst_ni), .io_validin(valid_i), .io_op(2'b0), .io_a(float_peers_pkg::recoded(a_i)),
    .io_b(float_peers_pkg::recoded(Does == 1 ? 32'h3f800000 : b_i)),
    .io_c(float_peers_pkg::recoded(Does == 0 ? zero : Does == 1 ? b_i : c_i)),
    .io_roundingMode(rounding_mode_i), .io_out(result), .io_exceptionFlags(flags_o));
endmodule

module hardfloat_divide (`FLOAT_PEER_PORTS);
  logic [32:0] result;
  assign result_o = float_peers_pkg::decoded(result);
  DivSqrtRecFN_small u_core (
    .clock(clk_i), .reset(!rst_ni), .io_inReady(ready_o), .io_inValid(valid_i), .io_sqrtOp(1'b0),
    .io_a(float_peers_pkg::recoded(a_i)), .io_b(float_peers_pkg::recoded(b_i)), .io_roundingMode(rounding_mode_i),
    .io_outValid_div(valid_o), .io_outValid_sqrt(), .io_out(result), .io_exceptionFlags(flags_o));
endmodule

module cvfpu_multiply_add #(
  parameter int unsigned Does = 0  // 0: a * b, 1: a + b, 2: a * b + c
) (`FLOAT_PEER_PORTS, input logic [31:0] c_i);
  fpnew_fma #(.FpFormat(fpnew_pkg::FP32)) u_core (
    .clk_i, .rst_ni, .operands_i(Does == 1 ? {b_i, a_i, 32'b0} : {c_i, b_i, a_i}), .is_boxed_i('1),
    .rnd_mode_i(fpnew_pkg::roundmode_e'(rounding_mode_i)), .op_i(Does == 0 ? fpnew_pkg::MUL : Does == 1 ? fpnew_pkg::ADD : fpnew_pkg::FMADD), .op_mod_i(1'b0), .tag_i(1'b0),
    .mask_i(1'b1), .aux_i(1'b0), .in_valid_i(valid_i), .in_ready_o(ready_o), .flush_i(1'b0), .result_o, .status_o(flags_o),
    .extension_bit_o(), .tag_o(), .mask_o(), .aux_o(), .out_valid_o(valid_o), .out_ready_i(1'b1), .busy_o(), .reg_ena_i('0));
endmodule

module cvfpu_divide (`FLOAT_PEER_PORTS);
  fpnew_divsqrt_th_32 u_core (
    .clk_i, .rst_ni, .operands_i({b_i, a_i}), .is_boxed_i('1), .rnd_mode_i(fpnew_pkg::roundmode_e'(rounding_mode_i)),
    .op_i(fpnew_pkg::DIV), .tag_i(1'b0), .mask_i(1'b1), .aux_i(1'b0), .in_valid_i(valid_i), .in_ready_o(ready_o), .flush_i(1'b0),
    .result_o, .status_o(flags_o), .extension_bit_o(), .tag_o(), .mask_o(), .aux_o(), .out_valid_o(valid_o), .out_ready_i(1'b1),
    .busy_o(), .reg_ena_i('0));
endmodule
