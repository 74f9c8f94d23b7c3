// Carry-save tree: the rows of rows_i add up to sum_o + carry_o modulo 2**Width.
//
// At every level each three rows become two, and up to two rows are passed on: from 14 rows 10, 7,
// 5, 4, 3 and 2, which takes 12 carry-save adders in 6 levels (the paper's tree, section 3.4).
// Row r of rows_i is rows_i[Width*r +: Width]. Rows from 2.
// Combinational; arith_pkg::tree_levels(Rows) full-adder delays.
module carry_save_tree #(
  parameter int unsigned Width = 48,
  parameter int unsigned Rows  = 14
) (
  input  logic [Width*Rows-1:0] rows_i,
  output logic [Width-1:0]      sum_o,
  output logic [Width-1:0]      carry_o
);

  localparam int unsigned Levels = arith_pkg::tree_levels(Rows);

  for (genvar l = 0; l <= Levels; l++) begin : gen_level
    localparam int unsigned Count = arith_pkg::tree_rows(Rows, l);
    logic [Width-1:0] row [Count];

    if (l == 0) begin : gen_inputs
      for (genvar r = 0; r < Count; r++) begin : gen_row
        assign row[r] = rows_i[Width*r +: Width];
      end
    end else begin : gen_compress
      localparam int unsigned Above = arith_pkg::tree_rows(Rows, l - 1);
      for (genvar k = 0; k < Above / 3; k++) begin : gen_adder
        carry_save_adder #(
          .Width(Width)
        ) u_adder (
          .a_i    (gen_level[l-1].row[3*k]),
          .b_i    (gen_level[l-1].row[3*k+1]),
          .c_i    (gen_level[l-1].row[3*k+2]),
          .sum_o  (row[2*k]),
          .carry_o(row[2*k+1])
        );
      end
      for (genvar r = 0; r < Above % 3; r++) begin : gen_pass
        assign row[2*(Above/3)+r] = gen_level[l-1].row[3*(Above/3)+r];
      end
    end
  end

  assign sum_o   = gen_level[Levels].row[0];
  assign carry_o = gen_level[Levels].row[1];

endmodule
