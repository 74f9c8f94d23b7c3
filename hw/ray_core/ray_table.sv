// The table of rays: what is known of each from its beginning, by its slot.
//
// A ray is given its slot and its reciprocals by ray_intake; it is in the table from the clock after
// start_taken_i until its slot is another's. What is read of a slot is there in the same clock.
module ray_table #(
  parameter int unsigned Rays  = 64,
  parameter int unsigned Arith = arith_pkg::Structural,
  parameter int unsigned Adder = arith_pkg::AdderGraded,
  localparam int unsigned RayWidth = $clog2(Rays)
) (
  input  logic                clk_i,
  input  logic                rst_ni,
  input  logic                valid_i,
  output logic                ready_o,
  input  ray_core_pkg::ray_t  ray_i,
  // a ray begins
  output logic                start_valid_o,
  output logic [RayWidth-1:0] start_slot_o,
  output logic [30:0]         start_limit_o,
  output logic [ray_core_pkg::AddressWidth-1:0] start_line_o,
  output logic                start_any_hit_o,
  input  logic                start_taken_i,
  // a ray has ended: its slot is free
  input  logic                ending_i,
  input  logic [RayWidth-1:0] ending_slot_i,
  output logic [31:0]         ending_tag_o,
  // for the boxes of a node, and for what is found among them
  input  logic [RayWidth-1:0] node_slot_i,
  output logic [95:0]         node_origin_o,
  output logic [95:0]         node_inverse_o,
  output logic                node_every_box_o,
  input  logic [RayWidth-1:0] box_slot_i,
  output logic [31:0]         box_tag_o,
  // for a test: its triangle, then its ray, then its result
  input  logic [RayWidth-1:0] triangle_slot_i,
  output logic [95:0]         triangle_origin_o,
  output logic [31:0]         triangle_ignored_o,
  input  logic [RayWidth-1:0] direction_slot_i,
  output logic [95:0]         direction_o,
  input  logic [RayWidth-1:0] result_slot_i,
  output logic [31:0]         result_tag_o
);

  ray_core_pkg::ray_t start;
  logic [95:0] inverse;

  ray_intake #(
    .Rays(Rays),
    .Width($bits(ray_i)),
    .Arith(Arith),
    .Adder(Adder)
  ) u_intake (
    .clk_i,
    .rst_ni,
    .valid_i,
    .ready_o,
    .direction_i(ray_i.direction),
    .ray_i,
    .free_valid_i(ending_i),
    .free_slot_i(ending_slot_i),
    .start_valid_o,
    .start_slot_o,
    .start_inverse_o(inverse),
    .start_ray_o(start),
    .start_taken_i
  );

  logic [95:0] origins[Rays];
  logic [95:0] directions[Rays];
  logic [95:0] inverses[Rays];
  logic [31:0] ignored[Rays];
  logic [31:0] tags[Rays];
  logic [Rays-1:0] every_box_q;

  always_ff @(posedge clk_i) begin
    if (start_taken_i) begin
      origins[start_slot_o]     <= start.origin;
      directions[start_slot_o]  <= start.direction;
      inverses[start_slot_o]    <= inverse;
      ignored[start_slot_o]     <= start.ignored;
      tags[start_slot_o]        <= start.tag;
      every_box_q[start_slot_o] <= start.every_box;
    end
  end

  assign start_limit_o      = start.limit;
  assign start_line_o       = start.start;
  assign start_any_hit_o    = start.any_hit;
  assign node_origin_o      = origins[node_slot_i];
  assign node_inverse_o     = inverses[node_slot_i];
  assign node_every_box_o   = every_box_q[node_slot_i];
  assign triangle_origin_o  = origins[triangle_slot_i];
  assign triangle_ignored_o = ignored[triangle_slot_i];
  assign direction_o        = directions[direction_slot_i];
  assign box_tag_o          = tags[box_slot_i];
  assign result_tag_o       = tags[result_slot_i];
  assign ending_tag_o       = tags[ending_slot_i];

endmodule
