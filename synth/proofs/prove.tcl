# Proves the assertions of TOP for all inputs. A TOP without any is refused.
#   SOURCES, TOP, PARAMETERS  as for elaborate.tcl
#   PREPARE                   a Tcl file that makes what TOP instantiates, or ""
#   SMT2                      "": by Yosys's SAT solver, here; else the file to write for an SMT one
yosys -import
if {$::env(PREPARE) ne ""} { source $::env(PREPARE) }
yosys read_verilog -formal -sv -defer {*}$::env(SOURCES)
set overrides {}
foreach {name value} $::env(PARAMETERS) { lappend overrides -chparam $name $value }
yosys hierarchy -check -top $::env(TOP) {*}$overrides
yosys proc
yosys flatten
yosys opt
yosys select -assert-min 1 t:\$assert
if {$::env(SMT2) ne ""} {
  yosys async2sync
  yosys dffunmap
  yosys write_smt2 -stbv -wires $::env(SMT2)
} else {
  yosys select -assert-none t:\$assume
  yosys sat -prove-asserts -show-ports -set-def-inputs
}
