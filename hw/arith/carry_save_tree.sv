// Carry-save tree: the rows of rows_i add up to sum_o + carry_o modulo 2**Width.
//
// A queue: each carry-save adder takes the three oldest rows and appends its sum and its carry,
// until two are left after Rows - 2 adders. So every level makes two rows of three and passes on
// what is left: of 14 rows 10, 7, 5, 4, 3 and 2 by 12 adders in 6 levels, the paper's tree (section
// 3.4).
//
// Row r of rows_i is rows_i[Width*r +: Width]; the last ones may arrive late. Rows from 2.
// Combinational; about log(Rows / 2) / log(1.5) full-adder delays.
module carry_save_tree #(
  parameter int unsigned Width = 48,
  parameter int unsigned Rows  = 14
) (
  input  logic [Width*Rows-1:0] rows_i,
  output logic [Width-1:0]      sum_o,
  output logic [Width-1:0]      carry_o
);

  localparam int unsigned Total = Rows + 2 * (Rows - 2);  // that are ever in the queue

  for (genvar r = 0; r < Total; r++) begin : gen_row
    logic [Width-1:0] row;
    if (r < Rows) begin : gen_given
      assign row = rows_i[Width*r+:Width];
    end else if ((r - Rows) % 2 == 0) begin : gen_sum
      localparam int unsigned Oldest = 3 * ((r - Rows) / 2);
      logic [Width-1:0] carry;
      carry_save_adder #(
        .Width(Width)
      ) u_adder (
        .a_i    (gen_row[Oldest].row),
        .b_i    (gen_row[Oldest+1].row),
        .c_i    (gen_row[Oldest+2].row),
        .sum_o  (row),
        .carry_o(carry)
      );
    end else begin : gen_carry
      assign row = gen_row[r-1].gen_sum.carry;
    end
  end

  assign sum_o   = gen_row[Total-2].row;
  assign carry_o = gen_row[Total-1].row;

endmodule
