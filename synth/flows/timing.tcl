# Times a mapped netlist with OpenSTA and reports the slowest path, cell by cell. Environment variables: LIBERTY,
# NETLIST, TOP, SDC, those of constraints.sdc, and SPEF (file of the wires' parasitics, or "").
read_liberty $::env(LIBERTY)
set_cmd_units -time ns -capacitance pF
read_verilog $::env(NETLIST)
link_design $::env(TOP)
read_sdc $::env(SDC)
if {$::env(SPEF) ne "" && ![read_spef $::env(SPEF)]} { error "no wires: $::env(SPEF)" }
# Reports only paths of the clock's group: recovery times of the reset do not limit the clock rate.
report_checks -path_delay max -path_group clock -digits 3 -fields {capacitance slew input_pins}
