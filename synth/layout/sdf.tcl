# Writes the delays of a layout's cells, each with the wires that it drives, to SDF, and checks nothing.
#   LIBERTY, NETLIST, TOP; SDC and what it names; SPEF; OUT
read_liberty $::env(LIBERTY)
read_verilog $::env(NETLIST)
link_design $::env(TOP)
read_sdc $::env(SDC)
read_spef $::env(SPEF)
write_sdf $::env(OUT)
