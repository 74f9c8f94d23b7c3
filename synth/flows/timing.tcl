# Times a mapped netlist with OpenSTA: the slowest path, cell by cell.
#   LIBERTY, NETLIST, TOP; DRIVER cell at the inputs; LOAD in pF at the outputs; CLOCK port or ""
read_liberty $::env(LIBERTY)
read_verilog $::env(NETLIST)
link_design $::env(TOP)
set data_inputs [all_inputs]
if {$::env(CLOCK) ne ""} {
  create_clock -name clock -period 1000 [get_ports $::env(CLOCK)]
} else {
  create_clock -name clock -period 1000
}
set_driving_cell -lib_cell $::env(DRIVER) [all_inputs]
set_input_delay 0 -clock clock [all_inputs]
set_output_delay 0 -clock clock [all_outputs]
set_load $::env(LOAD) [all_outputs]
report_checks -path_delay max -digits 3 -fields {capacitance slew input_pins}
