// Errors of the rays in flight: why a ray's hits must not be believed, the first reason of each.
//
// A ray has failed from the second clock after its first error on, no later than its end is told, and stays so until
// another begins in its context. While abort_i is high, all rays in the core fail.
module ray_errors
  import ray_core_pkg::*;
#(
  parameter int unsigned Rays = 64,
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                clk_i,
  input  logic                rst_ni,
  input  logic                abort_i,
  // a ray begins
  input  logic                start_i,
  input  logic [RayWidth-1:0] start_ctx_i,
  input  logic                start_scaled_i,  // its direction is scaled
  // a node's line or a triangle's comes with an error
  input  logic                node_i,
  input  logic [RayWidth-1:0] node_ctx_i,
  input  logic                triangle_i,
  input  logic [RayWidth-1:0] triangle_ctx_i,
  // a ray meets a node again
  input  logic                cycle_i,
  input  logic [RayWidth-1:0] cycle_ctx_i,
  output logic [Rays-1:0]     failed_o,
  // of one ray, in the same clock
  input  logic [RayWidth-1:0] end_ctx_i,
  output logic [2:0]          end_error_o
);

  logic [Rays-1:0][2:0] errors_q;
  logic node_q, triangle_q, cycle_q;
  logic [RayWidth-1:0] node_ctx_q, triangle_ctx_q, cycle_ctx_q;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) {node_q, triangle_q, cycle_q} <= '0;
    else {node_q, triangle_q, cycle_q} <= {node_i, triangle_i, cycle_i};
  end
  always_ff @(posedge clk_i) begin
    {node_ctx_q, triangle_ctx_q, cycle_ctx_q} <= {node_ctx_i, triangle_ctx_i, cycle_ctx_i};
  end

  for (genvar r = 0; r < Rays; r++) begin : gen_ray
    logic [2:0] error_d;

    assign failed_o[r] = errors_q[r] != ErrorNone;

    always_comb begin
      error_d = errors_q[r];
      if (!failed_o[r]) begin
        if (cycle_q && cycle_ctx_q == RayWidth'(r)) error_d = ErrorCycle;
        if ((node_q && node_ctx_q == RayWidth'(r))
            || (triangle_q && triangle_ctx_q == RayWidth'(r))) begin
          error_d = ErrorMemory;
        end
        if (abort_i) error_d = ErrorAbort;
      end
      if (start_i && start_ctx_i == RayWidth'(r)) begin
        error_d = !start_scaled_i ? ErrorDirection : abort_i ? ErrorAbort : ErrorNone;
      end
    end
    always_ff @(posedge clk_i or negedge rst_ni) begin
      if (!rst_ni) errors_q[r] <= ErrorNone;
      else errors_q[r] <= error_d;
    end
  end

  assign end_error_o = errors_q[end_ctx_i];

endmodule
