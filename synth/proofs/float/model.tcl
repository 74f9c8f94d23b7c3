# Writes TOP with PARAMETERS ("Name value ...") as functions of SMT-LIB to SMT2: one of a state for every
# wire, the state being the inputs and what contracts leave free.
#   SOURCES  what to read    KEEP  "" or a file for the netlist, for faults to be put into
yosys -import
yosys read_verilog -formal -sv -defer {*}$::env(SOURCES)
set overrides {}
foreach {name value} $::env(PARAMETERS) { lappend overrides -chparam $name $value }
yosys hierarchy -check -top $::env(TOP) {*}$overrides
yosys proc
yosys flatten
yosys opt
if {$::env(KEEP) ne ""} { yosys write_rtlil $::env(KEEP) }
yosys dffunmap
yosys write_smt2 -stbv -wires $::env(SMT2)
