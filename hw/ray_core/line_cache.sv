// Lines of one kind, nodes or triangles, that were read not long ago.
//
// Direct-mapped, Lines lines. A request that hits gives its line in the next clock; one that misses goes on to
// memory, and its line fills the cache as it passes. Lines leave in any order, one a clock, each with the ray
// that asked; those from memory first, while what hit waits. Two rays that miss the same line both read it.
//
// Memory is read only; invalidate_i empties the cache.
module line_cache #(
  parameter int unsigned Lines    = 256,  // a power of two
  parameter int unsigned RayWidth = 6,
  parameter int unsigned Width    = ray_core_pkg::LineWidth,  // of what is kept of a line
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth
) (
  input  logic                    clk_i,
  input  logic                    rst_ni,
  input  logic                    invalidate_i,
  // what is asked for
  input  logic                    valid_i,
  output logic                    ready_o,
  input  logic [RayWidth-1:0]     ray_i,
  input  logic [AddressWidth-1:0] line_number_i,
  // what is not here
  output logic                    miss_valid_o,
  input  logic                    miss_ready_i,
  output logic [RayWidth-1:0]     miss_ray_o,
  output logic [AddressWidth-1:0] miss_number_o,
  // what comes from memory
  input  logic                    fill_i,
  input  logic [RayWidth-1:0]     fill_ray_i,
  input  logic [AddressWidth-1:0] fill_number_i,
  input  logic [Width-1:0]    fill_line_i,
  // lines
  output logic                    valid_o,
  input  logic                    ready_i,  // else nothing leaves, and fill_i must be low
  output logic [RayWidth-1:0]     ray_o,
  output logic [Width-1:0]    line_o
);

  localparam int unsigned IndexWidth = $clog2(Lines);
  localparam int unsigned LabelWidth = AddressWidth - IndexWidth;

  logic [Width-1:0] words[Lines];
  logic [LabelWidth-1:0] labels[Lines];
  logic [Lines-1:0] held_q;

  // ---- Look up

  logic [IndexWidth-1:0] index, fill_index;
  logic hit, out_free;

  assign index      = line_number_i[IndexWidth-1:0];
  assign fill_index = fill_number_i[IndexWidth-1:0];
  assign hit = held_q[index] & (labels[index] == line_number_i[AddressWidth-1:IndexWidth]);
  assign ready_o       = hit ? out_free : miss_ready_i;
  assign miss_valid_o  = valid_i & ~hit;
  assign miss_ray_o    = ray_i;
  assign miss_number_o = line_number_i;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) held_q <= '0;
    else if (invalidate_i) held_q <= '0;
    else if (fill_i) held_q[fill_index] <= 1'b1;
  end
  always_ff @(posedge clk_i) begin
    if (fill_i) begin
      labels[fill_index] <= fill_number_i[AddressWidth-1:IndexWidth];
      words[fill_index]  <= fill_line_i;
    end
  end

  // ---- What hit, read in the next clock; a fill of its place must not come between

  logic hit_q;
  logic [RayWidth-1:0] ray_q;
  logic [Width-1:0] line_q;
  logic leaves;

  assign leaves   = hit_q & ready_i & ~fill_i;
  assign out_free = ~hit_q | leaves;

  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) hit_q <= 1'b0;
    else if (out_free) hit_q <= valid_i & hit;
  end
  always_ff @(posedge clk_i) begin
    if (out_free) begin
      ray_q  <= ray_i;
      line_q <= words[index];
    end
  end

  assign valid_o = fill_i | (hit_q & ready_i);
  assign ray_o   = fill_i ? fill_ray_i : ray_q;
  assign line_o  = fill_i ? fill_line_i : line_q;

endmodule
