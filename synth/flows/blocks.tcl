# Elaborates TOP and writes it as JSON to OUT, its cores left as they are instantiated.
yosys -import
set flows [file dirname [info script]]
source [file join $flows elaborate.tcl]
yosys proc
yosys opt_expr
yosys opt_dff
yosys memory_collect
yosys opt_clean
yosys write_json $::env(OUT)
