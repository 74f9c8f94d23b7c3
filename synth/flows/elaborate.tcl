# Reads SOURCES and elaborates TOP with PARAMETERS ("Name value Name value ...").
# -defer: a module is built when it is asked for, with its parameters, and not before.
yosys read_verilog -sv -defer -DSYNTHESIS {*}$::env(SOURCES)
set overrides {}
foreach {name value} $::env(PARAMETERS) { lappend overrides -chparam $name $value }
yosys hierarchy -check -top $::env(TOP) {*}$overrides
