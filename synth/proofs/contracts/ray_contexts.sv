// A ray core reduced to the start and end of rays: ray_alloc and ray_retire, connected as in ray_core. Start and
// duration of a ray's traversal are arbitrary. The rays' tags are reduced to one bit, which marks a ray.
module ray_contexts #(
  parameter int unsigned Rays = 4,
  localparam int unsigned CtxWidth = $clog2(Rays)
) (
  input  logic                 clk_i,
  input  logic                 rst_ni,
  input  logic                 ray_valid_i,
  input  logic                 ray_mark_i,
  output logic                 ray_ready_o,
  input  logic                 start_i,  // traversal takes a waiting ray
  input  logic [Rays-1:0]      busy_i,
  output logic                 started_o,
  output logic [CtxWidth-1:0] started_ctx_o,
  output logic                 ending_o,
  output logic [CtxWidth-1:0] ending_ctx_o,
  output logic [Rays-1:0]      marks_o,      // per context: its ray is the marked ray
  output logic                 entering_o,   // the marked ray's end enters the queue
  input  logic                 doubt_valid_i,
  output logic                 result_valid_o,
  input  logic                 result_ready_i,
  output logic                 result_kind_o,
  output logic                 result_mark_o
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
    .ray_i(ray_mark_i),
    .free_valid_i(ending_o),
    .free_ctx_i(ending_ctx_o),
    .start_valid_o(start_valid),
    .start_ctx_o(started_ctx_o),
    .start_inverse_o(inverse),
    .start_ray_o(ray),
    .start_fire_i(started_o)
  );

  (* anyseq *) ray_core_pkg::end_t known;
  (* anyseq *) logic [95:0] point;
  logic [CtxWidth-1:0] end_ctx;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      marks_o    <= '0;
      entering_o <= 1'b0;
    end else begin
      if (ending_o) marks_o[ending_ctx_o] <= 1'b0;
      if (started_o) marks_o[started_ctx_o] <= ray;
      entering_o <= ending_o & marks_o[ending_ctx_o];
    end
  end
  logic doubt_fire;
  ray_core_pkg::result_t result;
  assign result_kind_o  = result.kind;
  assign result_mark_o  = result.tag[31];

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
    .end_i({entering_o, {$bits(known) - 1{1'b0}}} | (known >> 1)),
    .point_i(point),
    .doubt_i({doubt_valid_i, 64'd0}),
    .doubt_fire_o(doubt_fire),
    .result_valid_o,
    .result_ready_i,
    .result_o(result)
  );

endmodule

// Contract of a queue: keeps only the highest bit of each word. Proof unit.fifo shows that the real queue keeps order.
module fifo #(
  parameter int unsigned Width   = 32,
  parameter int unsigned Depth   = 64,
  parameter int unsigned Reserve = 0,
  parameter bit          Memory  = 1'b0,
  localparam int unsigned CountWidth = $clog2(Depth + 1)
) (
  input  logic             clk_i,
  input  logic             rst_ni,
  input  logic             push_i,
  input  logic [Width-1:0] data_i,
  output logic             space_o,
  input  logic             pop_i,
  output logic             valid_o,
  output logic [Width-1:0] data_o
);
  (* anyseq *) logic [Width-1:0] any;
  logic [CountWidth-1:0] count_q, count_d, last;
  logic [Depth-1:0] bits_q, bits;  // bit 0: the next word to leave; 0 above the last word
  assign data_o  = Width'({bits_q[0], any} >> 1);
  assign last    = count_q - CountWidth'(pop_i);
  assign bits    = pop_i ? bits_q >> 1 : bits_q;
  assign count_d = last + CountWidth'(push_i);
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      count_q <= '0;
      valid_o <= 1'b0;
      space_o <= 1'b1;
      bits_q  <= '0;
    end else begin
      count_q <= count_d;
      valid_o <= Memory ? (count_q != CountWidth'(valid_o) & (~valid_o | pop_i)) | (valid_o & ~pop_i) : count_d != '0;
      space_o <= count_d < CountWidth'(Depth - Reserve);
      bits_q  <= bits | (Depth'(push_i & data_i[Width-1]) << last);
    end
  end
endmodule

// A divider that gives any quotient.
module fp_divider #(
  parameter int unsigned ExpWidth     = 8,
  parameter int unsigned FracWidth    = 23,
  parameter int unsigned Arith        = 0,
  parameter int unsigned QuotientBits = 0,
  parameter bit          Pipelined     = 1'b0
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
