# Maps one design to a standard-cell library. Everything comes in through the environment:
#   SOURCES   files to read, packages first        TOP, PARAMETERS   the design
#   FLOW      cells | kept | default | area | small | fast | faster | parts | modules | blocks
#   BLOCKS    flow blocks: modules, beside the float cores, that ABC maps on their own
#   ABC_SCRIPT  what ABC does, as -script FILE, or "" for Yosys's own
#   LIBERTY   the library                          CONSTRAINTS       driver and load, for ABC
#   OUT       prefix of the files written
set flows [file dirname [info script]]
source [file join $flows elaborate.tcl]

switch $::env(FLOW) {
  default - area - small {
    # Yosys's own recipe. -noshare: its SAT-based resource sharing can run for ever.
    yosys synth -flatten -noshare -noabc -top $::env(TOP)
  }
  fast - faster - kept - parts - modules - blocks {
    # Nothing here looks across a multiplexer, so carry-select stays carry-select.
    yosys proc
    # A read enable becomes the memory's, or its word would wait in a register behind it.
    if {$::env(FLOW) eq "blocks"} { yosys opt_dff -nosdff ram *\\ram *\\ram\\* }
    if {$::env(FLOW) in {parts blocks}} {
      # ABC maps each float core on its own, and once, however often it is instantiated.
      yosys setattr -mod -set keep_hierarchy 1 *fp_*_stages*
    }
    if {$::env(FLOW) eq "modules"} {
      # So that a picture of the layout can tell them apart.
      foreach module {booth_encoder booth_row carry_save_tree adder fp_unpack fp_round fp_normalize
          srt_first_row srt_row sticky_right_shift leading_zero_counter comparator} {
        yosys setattr -mod -set keep_hierarchy 1 *\\\\$module
      }
    }
    if {$::env(FLOW) eq "blocks"} {
      foreach block $::env(BLOCKS) {
        yosys setattr -mod -set keep_hierarchy 1 $block *\\$block *\\$block\\*
      }
    }
    yosys flatten
    yosys opt_expr
    yosys opt_merge
    yosys opt_clean
    if {$::env(FLOW) eq "blocks"} {
      yosys memory -nomap
      yosys read_verilog -lib [file join $flows kept_memory.v]
      yosys techmap -map [file join $flows kept_memories.v]
      yosys tee -q -o $::env(OUT).memories dump t:kept_memory
    }
    yosys memory
    yosys wreduce
    yosys alumacc
    yosys opt_expr
    yosys opt_clean
    yosys techmap
    yosys opt_expr
    yosys opt_merge
    yosys opt_clean
  }
  cells {
    # Full adders and multiplexers become the library's own cells, out of ABC's reach.
    source [file join $flows structure.tcl]
    yosys techmap -map [file join $flows osu_cells.v]
    yosys techmap
    yosys opt_expr
    yosys opt_clean
  }
}
yosys dfflibmap -liberty $::env(LIBERTY)
yosys abc -liberty $::env(LIBERTY) -constr $::env(CONSTRAINTS) {*}$::env(ABC_SCRIPT)
yosys setattr -mod -unset keep_hierarchy *
if {$::env(FLOW) eq "blocks"} { yosys tee -q -o $::env(OUT).blocks stat -liberty $::env(LIBERTY) }
yosys flatten
if {$::env(FLOW) eq "blocks"} {
  yosys techmap -map [file join $flows kept_enables.v]
  yosys expose -evert $::env(TOP)/t:kept_input $::env(TOP)/t:kept_output
  yosys delete $::env(TOP)/t:kept_memory
}
yosys splitnets
yosys opt_clean -purge
yosys tee -q -o $::env(OUT).stat stat -liberty $::env(LIBERTY)
yosys write_verilog -noattr -noexpr -nohex $::env(OUT).v
# The same for OpenSTA, which reads no concatenations in assignments: each bit a port of its own.
yosys splitnets -ports
yosys opt_clean -purge
yosys write_verilog -noattr -noexpr -nohex $::env(OUT).timed.v
yosys write_json $::env(OUT).json
