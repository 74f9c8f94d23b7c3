// A plane of a node's grid: from_i + floor(q_i s / 256) or, with back_i, from_i - floor(q_i s / 256); s is step_i.
// Latency: 1 clock from q_i and step_i (a register after the product). from_i and back_i come a clock later, in the
// clock in which plane_o is valid.
//
// Structural kinds: a carry-save tree with a row for each bit of q, a register for the tree's two output words, and one
// adder, which computes the difference as floor((256 from + 255 - q s) / 256). Behavioural uses `*`.
module plane_offset #(
  parameter int unsigned Width = 33,  // width of s
  parameter int unsigned PlaneWidth = 36,
  parameter int unsigned Arith = arith_pkg::Graded
) (
  input  logic                  clk_i,
  input  logic [7:0]            q_i,
  input  logic [Width-1:0]      step_i,
  input  logic [PlaneWidth-1:0] from_i,
  input  logic                  back_i,  // 1: subtract
  output logic [PlaneWidth-1:0] plane_o
);

  localparam int unsigned SumWidth = PlaneWidth + 8;

  if (Arith == arith_pkg::Behavioural) begin : gen_behavioural
    logic [SumWidth-1:0] product_q;
    logic unused;  // the product's fraction of a unit
    assign unused = ^product_q[7:0];

    always_ff @(posedge clk_i) product_q <= SumWidth'(q_i) * SumWidth'(step_i);
    assign plane_o = back_i ? from_i - product_q[SumWidth-1:8] : from_i + product_q[SumWidth-1:8];
  end else begin : gen_rows
    logic [8*SumWidth-1:0] rows;
    logic [SumWidth-1:0] tree_sum, tree_carry, sum_q, carry_q, sum, carry, planes;
    logic unused;
    assign unused = ^planes[7:0];

    for (genvar b = 0; b < 8; b++) begin : gen_row
      assign rows[SumWidth*b+:SumWidth] = q_i[b] ? SumWidth'(step_i) << b : '0;
    end
    carry_save_tree #(
      .Width(SumWidth),
      .Rows(8)
    ) u_tree (
      .rows_i(rows),
      .sum_o(tree_sum),
      .carry_o(tree_carry)
    );
    always_ff @(posedge clk_i) begin
      sum_q   <= tree_sum;
      carry_q <= tree_carry;
    end

    carry_save_adder #(
      .Width(SumWidth)
    ) u_from (
      .a_i({from_i, {8{back_i}}}),
      .b_i(sum_q ^ {SumWidth{back_i}}),
      .c_i(carry_q ^ {SumWidth{back_i}}),
      .sum_o(sum),
      .carry_o(carry)
    );
    adder #(
      .Width(SumWidth),
      .Arith(Arith)
    ) u_adder (
      .a_i(sum),
      .b_i(carry | SumWidth'(back_i)),
      .carry_i(back_i),
      .sum_o(planes),
      .carry_o()
    );
    assign plane_o = planes[SumWidth-1:8];
  end

endmodule
