# Writes a design, flattened down to the cells of structure.v and gates, as JSON to OUT.
yosys -import
set flows [file dirname [info script]]
source [file join $flows elaborate.tcl]
source [file join $flows structure.tcl]
yosys simplemap
yosys opt_clean
yosys write_json $::env(OUT)
