# Writes the RTL and its netlist as rtl.blif and netlist.blif, for ABC's `cec`.
#   SOURCES, TOP, PARAMETERS, CUT, TIED  as for elaborate.tcl
#   LIBERTY  the library, whose own functions say what its cells do    NETLIST    OUT  folder
proc write {file} {
  yosys flatten
  yosys opt_expr
  yosys techmap
  yosys opt_clean -purge
  yosys select -assert-none t:\$*FF*
  yosys write_blif [file join $::env(OUT) $file]
}
yosys -import
source [file join [file dirname [info script]] .. flows elaborate.tcl]
yosys proc
write rtl.blif
yosys design -reset
yosys read_liberty -ignore_miss_func -ignore_miss_dir -ignore_miss_data_latch $::env(LIBERTY)
yosys delete LATCH TBUFX1 TBUFX2 PAD*
yosys read_verilog $::env(NETLIST)
yosys hierarchy -check -top $::env(TOP)
yosys proc
write netlist.blif
