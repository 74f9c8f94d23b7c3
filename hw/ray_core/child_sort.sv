// Sort of a node's children: those that the ray enters, near first.
// Latency: 4 clocks: two registers in the sort, one after it and one after the group. keys_i come from slab_test.
module child_sort
  import ray_core_pkg::*;
#(
  localparam int unsigned KeyWidth = UnitBits + 2
) (
  input  logic                          clk_i,
  input  logic [Children*KeyWidth-1:0]  keys_i,
  input  logic [Children*KindWidth-1:0] kinds_i,
  input  logic [AddressWidth-1:0]       base_i,
  input  logic [8:0]                    exponent_i,  // E
  output group_t                        group_o,
  output logic [Children-1:0]           inner_o,
  output logic [Children-1:0]           leaf_o
);

  localparam int unsigned NumberWidth = 3;
  localparam int unsigned WordWidth = KeyWidth + NumberWidth;
  localparam int unsigned UnitsWidth = 12;  // bits of a distance that are kept
  localparam int unsigned ZerosWidth = $clog2(UnitsWidth);

  // ---- Sort: {key, number of the child}

  localparam int unsigned SortLatency = 3;
  logic [Children*WordWidth-1:0] words, ordered, sorted;
  logic [Children-1:0][KindWidth-1:0] kinds;
  logic [Children-1:0][OffsetWidth-1:0] next_offsets, offsets;
  logic [AddressWidth-1:0] base;
  logic [8:0] last_field;  // exponent field of distances in [2**(E - 1), 2**E)

  for (genvar i = 0; i < Children; i++) begin : gen_word
    assign words[WordWidth*i+:WordWidth] = {keys_i[KeyWidth*i+:KeyWidth], NumberWidth'(i)};
  end
  sort7 #(
    .Width(WordWidth)
  ) u_sort (
    .clk_i,
    .words_i(words),
    .sorted_o(ordered)
  );
  delay_line #(
    .Width(Children * (KindWidth + OffsetWidth) + AddressWidth + 9),
    .Depth(SortLatency)
  ) u_sideband (
    .clk_i,
    .enable_i(1'b1),
    .data_i({kinds_i, next_offsets, base_i, exponent_i - 9'd1}),
    .data_o({kinds, offsets, base, last_field})
  );

  // ---- Offsets of the children's first lines, which are consecutive

  always_comb begin : lines
    logic [OffsetWidth-1:0] next;
    logic [KindWidth-1:0] kind;
    next = '0;
    for (int unsigned i = 0; i < Children; i++) begin
      next_offsets[i] = next;
      kind = kinds_i[KindWidth*i +: KindWidth];
      next = next + ((kind == KindInner) ? OffsetWidth'(1) : OffsetWidth'(kind[LeafWidth-1:0]));
    end
  end

  // ---- Entries

  logic [Children*ChildWidth-1:0] entries;
  logic [Children-1:0] inner, leaf;

  for (genvar n = 0; n < Children; n++) begin : gen_entry
    logic [NumberWidth-1:0] number;
    logic [KeyWidth-1:0] key;
    logic [KindWidth-1:0] kind;
    logic [UnitsWidth-1:0] distance, fraction;
    logic [ZerosWidth-1:0] zeros;
    logic [8:0] field;
    logic [EnterWidth-1:0] enter;
    logic is_inner, left_out, is_zero;
    assign {key, number} = sorted[WordWidth*n +: WordWidth];
    assign kind     = kinds[number];
    assign is_inner = kind == KindInner;
    assign left_out = key[KeyWidth-1];
    assign inner[n] = ~left_out & is_inner;
    assign leaf[n]  = ~left_out & ~is_inner;

    // The distance as the upper bits of a binary32 number, rounded down
    leading_zero_counter #(
      .Width(UnitsWidth)
    ) u_zeros (
      .a_i(distance),
      .count_o(zeros),
      .zero_o(is_zero)
    );
    assign distance    = key[UnitBits] ? '1 : key[UnitBits-1 -: UnitsWidth];
    assign fraction = distance << zeros;
    assign field    = last_field - 9'(zeros);
    assign enter    = is_zero ? '0 : field[8] ? '1 : {field[7:0], fraction[UnitsWidth-2:0]};
    assign entries[ChildWidth*n +: ChildWidth] = {
        enter, offsets[number],
        is_inner ? LeafWidth'(0) : kind[LeafWidth-1:0]};
    logic unused;  // bits below an entry's precision
    assign unused = ^{key[UnitBits-UnitsWidth-1:0], fraction[UnitsWidth-1]};
  end

  always_ff @(posedge clk_i) begin
    sorted  <= ordered;
    group_o <= {base, entries};
    inner_o <= inner;
    leaf_o  <= leaf;
  end

endmodule
