// The paper's unit and the iterative unit with the same inputs, in formats and rounding modes other than the default.
// Both units return the same three words per test, the iterative unit later.
//
// bfloat16 units read the upper half of bus_i, binary16 units the lower half.
module siblings_top (
  input  logic         clk_i,
  input  logic         rst_ni,
  input  logic         valid_i,
  output logic         ready_o,
  input  logic [31:0]  bus_i,
  output logic [5:0]   paper_valid_o,
  output logic [191:0] paper_bus_o,
  output logic [5:0]   valid_o,
  output logic [191:0] bus_o
);

  // One byte per kind: exponent bits, fraction bits, rounding mode
  localparam bit [6*24-1:0] Kinds = {
    24'h08_17_02,  // binary32, down
    24'h08_17_03,  // binary32, up
    24'h08_17_01,  // binary32, towards zero
    24'h05_0a_00,  // binary16, to the nearest even
    24'h05_0a_04,  // binary16, to the nearest, ties away
    24'h08_07_02   // bfloat16, down
  };
  logic [5:0] ready, paper_ready;

  for (genvar n = 0; n < 6; n++) begin : gen_kind
    localparam int unsigned ExpWidth = 32'(Kinds[24*n+16 +: 8]);
    localparam int unsigned FracWidth = 32'(Kinds[24*n+8 +: 8]);
    localparam bit [2:0] RoundingMode = Kinds[24*n +: 3];
    localparam int unsigned Width = 1 + ExpWidth + FracWidth;
    logic [Width-1:0] bus, paper_out, out;

    assign bus = (FracWidth == 7) ? Width'(bus_i >> 16) : Width'(bus_i);

    hit_test_unit #(
      .ExpWidth(ExpWidth), .FracWidth(FracWidth), .Arith(1), .RoundingMode(RoundingMode)
    ) u_paper (
      .clk_i, .rst_ni, .valid_i, .ready_o(paper_ready[n]), .bus_i(bus), .bus_o(paper_out),
      .valid_o(paper_valid_o[n])
    );
    iterative_hit_test_unit #(
      .ExpWidth(ExpWidth), .FracWidth(FracWidth), .Arith(1), .RoundingMode(RoundingMode)
    ) u_iterative (
      .clk_i, .rst_ni, .valid_i, .ready_o(ready[n]), .bus_i(bus), .bus_o(out), .valid_o(valid_o[n])
    );
    assign paper_bus_o[32*n +: 32] = 32'(paper_out);
    assign bus_o[32*n +: 32] = 32'(out);
  end

  assign ready_o = &ready & &paper_ready;

endmodule
