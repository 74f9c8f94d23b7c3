# Times a mapped netlist with OpenSTA: the slowest path, cell by cell.
#   LIBERTY, NETLIST, TOP; DRIVER cell at the inputs; LOAD in pF at the outputs; CLOCK port or "";
#   ENDS 1: also when each output is there
read_liberty $::env(LIBERTY)
read_verilog $::env(NETLIST)
link_design $::env(TOP)
if {$::env(CLOCK) ne ""} {
  create_clock -name clock -period 1000 [get_ports $::env(CLOCK)]
} else {
  create_clock -name clock -period 1000
}
set_driving_cell -lib_cell $::env(DRIVER) [all_inputs]
foreach input [all_inputs] {
  if {[get_property $input full_name] ne $::env(CLOCK)} { set_input_delay 0 -clock clock $input }
}
set_output_delay 0 -clock clock [all_outputs]
set_load $::env(LOAD) [all_outputs]
# The clock's paths alone: how long a reset is held is not the clock rate's affair.
report_checks -path_delay max -path_group clock -digits 3 -fields {capacitance slew input_pins}
if {$::env(ENDS)} {
  report_checks -path_delay max -path_group clock -format end -digits 3 \
    -group_count [llength [all_outputs]]
}
