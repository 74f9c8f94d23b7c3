// Sort of a node's children: the group of those that the ray enters, near first.
// Latency: 2 clocks, a register half way through the sort and one behind the group. keys_i are slab_test's.
module child_sort #(
  parameter int unsigned Arith = arith_pkg::Structural,
  localparam int unsigned Children = ray_core_pkg::Children,
  localparam int unsigned KindWidth = ray_core_pkg::KindWidth,
  localparam int unsigned AddressWidth = ray_core_pkg::AddressWidth,
  localparam int unsigned UnitBits = ray_core_pkg::UnitBits,
  localparam int unsigned KeyWidth = UnitBits + 2
) (
  input  logic                                 clk_i,
  input  logic [Children*KeyWidth-1:0]         keys_i,
  input  logic [Children*KindWidth-1:0]        kinds_i,
  input  logic [AddressWidth-1:0]              base_i,
  input  logic [ray_core_pkg::ExponentWidth-1:0] exponent_i,
  output logic [ray_core_pkg::GroupWidth-1:0]  group_o,
  output logic [Children-1:0]                  inner_o,
  output logic [Children-1:0]                  leaf_o
);

  localparam int unsigned EnterWidth = ray_core_pkg::EnterWidth;
  localparam int unsigned OffsetWidth = ray_core_pkg::OffsetWidth;
  localparam int unsigned CountWidth = ray_core_pkg::CountWidth;
  localparam int unsigned EntryWidth = ray_core_pkg::EntryWidth;
  localparam int unsigned NumberWidth = 3;
  localparam int unsigned WordWidth = KeyWidth + NumberWidth;

  // ---- Sort: {key, number of the child}

  logic [Children*WordWidth-1:0] words, sorted;
  logic [Children*KindWidth-1:0] kinds_q;
  logic [AddressWidth-1:0] base_q;
  logic [ray_core_pkg::ExponentWidth-1:0] exponent_q;

  for (genvar i = 0; i < Children; i++) begin : gen_word
    assign words[WordWidth*i+:WordWidth] = {keys_i[KeyWidth*i+:KeyWidth], NumberWidth'(i)};
  end
  sort7 #(
    .Width(WordWidth),
    .Arith(Arith)
  ) u_sort (
    .clk_i,
    .words_i(words),
    .sorted_o(sorted)
  );
  always_ff @(posedge clk_i) begin
    kinds_q    <= kinds_i;
    base_q     <= base_i;
    exponent_q <= exponent_i;
  end

  // ---- The children's first lines follow each other

  logic [Children*OffsetWidth-1:0] offsets;

  always_comb begin : lines
    logic [OffsetWidth-1:0] next;
    logic [KindWidth-1:0] kind;
    next = '0;
    for (int unsigned i = 0; i < Children; i++) begin
      offsets[OffsetWidth*i +: OffsetWidth] = next;
      kind = kinds_q[KindWidth*i +: KindWidth];
      next = next + ((kind == ray_core_pkg::KindInner) ? OffsetWidth'(1)
                                                       : OffsetWidth'(kind[CountWidth-1:0]));
    end
  end

  // ---- Entries

  logic [Children*EntryWidth-1:0] entries;
  logic [Children-1:0] inner, leaf;

  for (genvar n = 0; n < Children; n++) begin : gen_entry
    logic [NumberWidth-1:0] number;
    logic [KeyWidth-1:0] key;
    logic [KindWidth-1:0] kind;
    logic [EnterWidth-1:0] enter;
    logic is_inner, left_out;
    assign {key, number} = sorted[WordWidth*n +: WordWidth];
    assign kind     = kinds_q[KindWidth*number +: KindWidth];
    assign is_inner = kind == ray_core_pkg::KindInner;
    assign left_out = key[KeyWidth-1];
    assign inner[n] = ~left_out & is_inner;
    assign leaf[n]  = ~left_out & ~is_inner;
    assign enter    = key[UnitBits] ? '1 : key[UnitBits-1 -: EnterWidth];
    assign entries[EntryWidth*n +: EntryWidth] = {
        enter, offsets[OffsetWidth*number +: OffsetWidth],
        is_inner ? CountWidth'(0) : kind[CountWidth-1:0]};
    logic unused;  // what is less than an entry's unit
    assign unused = ^key[UnitBits-EnterWidth-1:0];
  end

  always_ff @(posedge clk_i) begin
    group_o <= {base_q, exponent_q, entries};
    inner_o <= inner;
    leaf_o  <= leaf;
  end

endmodule
