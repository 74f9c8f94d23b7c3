# Writes the delays of a layout's cells, each with the wires that it drives, to SDF.
#   LIBERTY, NETLIST, TOP; SDC and what it names; SPEF: its wires, or ""; OUT
read_liberty $::env(LIBERTY)
read_verilog $::env(NETLIST)
link_design $::env(TOP)
read_sdc $::env(SDC)
if {$::env(SPEF) ne "" && ![read_spef $::env(SPEF)]} { error "no wires: $::env(SPEF)" }
write_sdf $::env(OUT)
