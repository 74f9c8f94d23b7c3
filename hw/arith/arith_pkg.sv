// The kinds of arithmetic, and the group widths of carry-select adders.
//
// Arith, a parameter of every arithmetic module, is one of arith_e. (It is declared as a number, because tools can
// override only numbers from outside.) Behavioural uses the language's own +, * and <, for tools that map these to DSP
// blocks and carry chains. The other kinds are structural: Booth recoding, carry-save trees and adders of the named
// kind. All kinds have the same pipeline stages and give the same bits.
//
// A list of group widths is a vector of MaxGroups bytes. The least significant group is lowest; a byte of 0 ends it.
package arith_pkg;

  typedef enum int unsigned {
    Graded      = 0,  // carry-select adders, groups that grow towards the top
    Behavioural = 1,
    Ripple      = 2,  // chains of full adders
    Uniform     = 3,  // carry-select adders, groups of one width
    Prefix      = 4   // Sklansky's parallel-prefix adders, for comparison
  } arith_e;

  localparam int unsigned MaxGroups = 16;

  // Returns groups of 4 bits; the top group is narrower if 4 does not divide `width`. If that takes more than MaxGroups
  // groups, all groups are as wide as needed. At 48 bits: 12 groups and the paper's 14 full-adder delays (4 full
  // adders, then 10 multiplexers of the carry that selects the top group's sum).
  function automatic bit [8*MaxGroups-1:0] uniform_groups(int unsigned width);
    int unsigned size, left;
    size = (width <= 4 * MaxGroups) ? 4 : (width + MaxGroups - 1) / MaxGroups;
    left = width;
    uniform_groups = '0;
    for (int unsigned k = 0; k < MaxGroups; k++) begin
      uniform_groups[8*k +: 8] = 8'((left < size) ? left : size);
      left = (left < size) ? 0 : left - size;
    end
  endfunction

  // Returns graded groups: each group, but for the lowest two, is one bit wider than the group below it. So a group's
  // carry in arrives just when its two sums are ready, if a full adder and a multiplexer have a delay of one each. The
  // top group has d bits, where d is the adder's delay: the least d for which groups of 1, 1, 2, 3 ... d bits have
  // `width` bits or more. From the top down, groups have d, d - 1 ... bits; the lowest has the rest, once that is no
  // wider than the group above. At 48 bits: 3, 5, 6, 7, 8, 9, 10, the paper's 10 full-adder delays. Valid up to 121
  // bits; beyond that, MaxGroups can be too few, and carry_select_adder refuses the list.
  function automatic bit [8*MaxGroups-1:0] graded_groups(int unsigned width);
    int unsigned size, left;
    size = 1;
    for (int unsigned d = 1; d * (d + 1) / 2 + 1 < width; d++) size = d + 1;
    left = width;
    graded_groups = '0;
    for (int unsigned k = 0; k < MaxGroups; k++) begin
      if (left != 0) begin  // insert a group below the groups placed so far
        if (left < size) size = left;
        graded_groups = {graded_groups[8*MaxGroups-9:0], 8'(size)};
        left = left - size;
        if (left > size) size = size - 1;
      end
    end
  endfunction

  function automatic int unsigned num_groups(bit [8*MaxGroups-1:0] widths);
    num_groups = 0;
    for (int unsigned k = 0; k < MaxGroups; k++) begin
      if (num_groups == k && widths[8*k+:8] != 0) num_groups = k + 1;
    end
  endfunction

  function automatic int unsigned widest_group(bit [8*MaxGroups-1:0] widths);
    widest_group = 0;
    for (int unsigned k = 0; k < MaxGroups; k++) begin
      if (32'(widths[8*k+:8]) > widest_group) widest_group = 32'(widths[8*k+:8]);
    end
  endfunction

  // Returns the index of the lowest bit of group k or, for k = MaxGroups, the number of bits of all groups together.
  function automatic int unsigned group_low(bit [8*MaxGroups-1:0] widths, int unsigned k);
    group_low = 0;
    for (int unsigned i = 0; i < MaxGroups; i++) begin
      if (i < k) group_low = group_low + 32'(widths[8*i+:8]);
    end
  endfunction

  // Returns a word with a 1 at the lowest bit of every group.
  function automatic bit [255:0] group_starts(bit [8*MaxGroups-1:0] widths);
    group_starts = '0;
    for (int unsigned k = 0; k < MaxGroups; k++) begin
      if (widths[8*k+:8] != 0) group_starts[group_low(widths, k)] = 1'b1;
    end
  endfunction

endpackage
