// Carry-save tree: rows_i add up to sum_o + carry_o modulo 2**Width.
//
// The rows form a queue: each carry-save adder takes the three oldest rows and appends its sum and its carry. Two rows
// are left after Rows - 2 adders. So every level turns each three rows into two and passes on the remainder: 14 rows
// become 10, 7, 5, 4, 3 and 2, with 12 adders in 6 levels, the paper's tree (section 3.4).
//
// Row r of rows_i is rows_i[Width*r +: Width]. The rows of highest r enter at later levels, so they may arrive late.
// Rows: 2 or more. Combinational; about log(Rows / 2) / log(1.5) full-adder delays.
module carry_save_tree #(
  parameter int unsigned Width = 48,
  parameter int unsigned Rows  = 14
) (
  input  logic [Width*Rows-1:0] rows_i,
  output logic [Width-1:0]      sum_o,
  output logic [Width-1:0]      carry_o
);

  localparam int unsigned Adders = Rows - 2;

  // Rows feed only later rows. Verilator sees that there is no loop if each row is a signal of its own (split_var).
  logic [Width*(Rows+2*Adders)-1:0] queue  /*verilator split_var*/;

  assign queue[Width*Rows-1:0] = rows_i;

  for (genvar k = 0; k < Adders; k++) begin : gen_adder
    carry_save_adder #(
      .Width(Width)
    ) u_adder (
      .a_i    (queue[Width*(3*k) +: Width]),
      .b_i    (queue[Width*(3*k+1) +: Width]),
      .c_i    (queue[Width*(3*k+2) +: Width]),
      .sum_o  (queue[Width*(Rows+2*k) +: Width]),
      .carry_o(queue[Width*(Rows+2*k+1) +: Width])
    );
  end

  assign {carry_o, sum_o} = queue[Width*(3*Adders)+:2*Width];

endmodule
