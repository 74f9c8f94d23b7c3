// Multipliers of many widths with the same operands: Booth multipliers with the constants in the partial products or in
// a separate row, `*`, and a 24-bit Booth multiplier with each kind of adder.
module multipliers_top (
  input  logic               clk_i,
  input  logic [31:0]        a_i,
  input  logic [31:0]        b_i,
  output logic [64*24-1:0]   product_o,        // 64 bits for each width of Widths, ConstantRow 0 and 1
  output logic [64*12-1:0]   product_own_o,    // `*`: 64 bits for each width of Widths
  output logic [64*4-1:0]    product_24_o      // 64 bits for each kind of adder
);

  localparam int unsigned NumWidths = 12;
  localparam bit [8*NumWidths-1:0] Widths = {
    8'd32, 8'd23, 8'd16, 8'd11, 8'd9, 8'd8, 8'd7, 8'd6, 8'd5, 8'd4, 8'd3, 8'd2
  };

  logic [31:0] a, b;

  always_ff @(posedge clk_i) begin
    a <= a_i;
    b <= b_i;
  end

  for (genvar w = 0; w < NumWidths; w++) begin : gen_width
    localparam int unsigned Width = 32'(Widths[8*w+:8]);

    for (genvar c = 0; c < 2; c++) begin : gen_constants
      logic [2*Width-1:0] product;

      booth_multiplier #(
        .Width      (Width),
        .ConstantRow(c == 1)
      ) u_multiplier (
        .a_i      (a[Width-1:0]),
        .b_i      (b[Width-1:0]),
        .product_o(product)
      );

      assign product_o[64*(2*w+c)+:64] = 64'(product);
    end

    logic [2*Width-1:0] product_own;

    multiplier #(
      .Width(Width),
      .Arith(arith_pkg::Behavioural)
    ) u_own (
      .a_i      (a[Width-1:0]),
      .b_i      (b[Width-1:0]),
      .product_o(product_own)
    );

    assign product_own_o[64*w+:64] = 64'(product_own);
  end

  for (genvar k = 0; k < 4; k++) begin : gen_kind
    logic [47:0] product;

    multiplier #(
      .Width(24),
      .Arith((k == 0) ? arith_pkg::Graded : k + 1)
    ) u_multiplier (
      .a_i      (a[23:0]),
      .b_i      (b[23:0]),
      .product_o(product)
    );

    assign product_24_o[64*k+:64] = 64'(product);
  end

endmodule
