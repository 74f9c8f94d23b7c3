// A ray core of which nothing is left but rays that come and go: ray_alloc and ray_retire as ray_core joins them.
// What is to be done for a ray is anything, and so is when its walk begins.
module ray_contexts #(
  parameter int unsigned Rays = 4,
  localparam int unsigned CtxWidth = $clog2(Rays)
) (
  input  logic                 clk_i,
  input  logic                 rst_ni,
  input  logic                 ray_valid_i,
  output logic                 ray_ready_o,
  input  logic                 start_i,  // the walk takes a ray that is there
  input  logic [Rays-1:0]      busy_i,
  output logic                 started_o,
  output logic [CtxWidth-1:0] started_ctx_o,
  output logic                 ending_o,
  output logic [CtxWidth-1:0] ending_ctx_o,
  input  logic                 doubt_valid_i,
  input  logic                 overflow_valid_i,
  output logic                 result_valid_o,
  input  logic                 result_ready_i,
  output logic [1:0]           result_kind_o
);

  logic start_valid;
  logic [95:0] inverse;
  logic ray;
  assign started_o = start_valid & start_i;

  ray_alloc #(
    .Rays(Rays),
    .Width(1)
  ) u_alloc (
    .clk_i,
    .rst_ni,
    .valid_i(ray_valid_i),
    .ready_o(ray_ready_o),
    .direction_i('0),
    .ray_i(1'b0),
    .free_valid_i(ending_o),
    .free_ctx_i(ending_ctx_o),
    .start_valid_o(start_valid),
    .start_ctx_o(started_ctx_o),
    .start_inverse_o(inverse),
    .start_ray_o(ray),
    .start_fire_i(started_o)
  );

  (* anyseq *) ray_core_pkg::end_t ended;
  (* anyseq *) logic [95:0] point;
  logic [CtxWidth-1:0] end_ctx, point_ctx;
  logic doubt_fire, overflow_fire;
  ray_core_pkg::result_t result;
  assign result_kind_o = result.kind;

  ray_retire #(
    .Rays(Rays)
  ) u_retire (
    .clk_i,
    .rst_ni,
    .start_i(started_o),
    .start_ctx_i(started_ctx_o),
    .busy_i,
    .ending_o,
    .ending_ctx_o,
    .end_ctx_o(end_ctx),
    .end_i(ended),
    .point_ctx_o(point_ctx),
    .point_i(point),
    .doubt_i({doubt_valid_i, 64'd0}),
    .doubt_fire_o(doubt_fire),
    .overflow_i({overflow_valid_i, {32 + ray_core_pkg::AddressWidth + ray_core_pkg::NodesWidth{1'b0}}}),
    .overflow_fire_o(overflow_fire),
    .result_valid_o,
    .result_ready_i,
    .result_o(result)
  );

endmodule

// A divider that promises nothing.
module fp_divider_stages #(
  parameter int unsigned ExpWidth     = 8,
  parameter int unsigned FracWidth    = 23,
  parameter int unsigned Arith        = 0,
  parameter int unsigned Adder        = 0,
  parameter int unsigned QuotientBits = 0,
  parameter bit [31:0]   PipeRegs     = 32'd0
) (
  input  logic                        clk_i,
  input  logic                        valid_i,
  input  logic [ExpWidth+FracWidth:0] a_i,
  input  logic [ExpWidth+FracWidth:0] b_i,
  input  logic [2:0]                  rounding_mode_i,
  input  logic                        tininess_after_i,
  output logic [ExpWidth+FracWidth:0] result_o,
  output fp_pkg::flags_t              flags_o
);
  (* anyseq *) logic [ExpWidth+FracWidth:0] any;
  assign result_o = any;
  assign flags_o = '0;
endmodule
