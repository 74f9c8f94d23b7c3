// ray_walk of two rays, with stacks of two groups.
module small_ray_walk (
  input  logic clk_i,
  input  logic rst_ni,
  input  logic start_valid_i,
  input  logic [0:0] start_ray_i,
  input  logic [ray_core_pkg::AddressWidth-1:0] start_line_i,
  output logic start_taken_o,
  input  logic box_valid_i,
  input  logic [0:0] box_ray_i,
  input  logic [31:0] box_tag_i,
  input  logic [ray_core_pkg::GroupWidth-1:0] box_group_i,
  input  logic [ray_core_pkg::Children-1:0] box_inner_i,
  input  logic [1:0] held_i,
  input  logic [1:0] testing_i,
  output logic [0:0] limit_ray_o,
  input  logic [30:0] limit_i,
  input  logic ended_i,
  output logic [1:0] walking_o,
  output logic node_valid_o,
  output logic [0:0] node_ray_o,
  output logic [ray_core_pkg::AddressWidth-1:0] node_line_o,
  output logic rest_valid_o,
  output logic [31:0] rest_tag_o,
  output logic [ray_core_pkg::AddressWidth-1:0] rest_line_o,
  output logic [ray_core_pkg::NodesWidth-1:0] rest_nodes_o,
  input  logic rest_taken_i
);

  ray_walk #(
    .Rays(2),
    .Depth(2)
  ) u_walk (
    .clk_i,
    .rst_ni,
    .start_valid_i,
    .start_ray_i,
    .start_line_i,
    .start_taken_o,
    .box_valid_i,
    .box_ray_i,
    .box_tag_i,
    .box_group_i,
    .box_inner_i,
    .held_i,
    .testing_i,
    .limit_ray_o,
    .limit_i,
    .ended_i,
    .walking_o,
    .node_valid_o,
    .node_ray_o,
    .node_line_o,
    .rest_valid_o,
    .rest_tag_o,
    .rest_line_o,
    .rest_nodes_o,
    .rest_taken_i
  );

endmodule
