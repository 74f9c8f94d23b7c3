# Times a mapped netlist with OpenSTA: the slowest path, cell by cell.
#   LIBERTY, NETLIST, TOP; SDC and the CLOCK, DRIVER and LOAD that it names; SPEF: its wires, or ""
read_liberty $::env(LIBERTY)
set_cmd_units -time ns -capacitance pF
read_verilog $::env(NETLIST)
link_design $::env(TOP)
read_sdc $::env(SDC)
if {$::env(SPEF) ne "" && ![read_spef $::env(SPEF)]} { error "no wires: $::env(SPEF)" }
# Only the clock's paths: how long a reset is held does not limit the clock rate.
report_checks -path_delay max -path_group clock -digits 3 -fields {capacitance slew input_pins}
