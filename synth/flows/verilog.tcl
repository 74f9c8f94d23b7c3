# Writes TOP, with PARAMETERS and all that it instantiates, as one file of plain Verilog: OUT.
yosys -import
source [file join [file dirname [info script]] elaborate.tcl]
yosys proc
yosys opt_expr
yosys opt_clean
yosys rename -top $::env(TOP)
yosys write_verilog -noattr $::env(OUT)
