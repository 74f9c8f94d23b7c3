# The constraints under which every design is timed, before and after layout. CLOCK: its port, or "" without one;
# DRIVER: the cell at its inputs; LOAD: pF at its outputs; ACCESS: ns from the clock edge at which a kept memory
# (kept_memories.v) takes an address to its word. The clock is the paper's, 10 MHz.
if {$::env(CLOCK) ne ""} {
  create_clock -name clock -period 100 [get_ports $::env(CLOCK)]
} else {
  create_clock -name clock -period 100
}
set_driving_cell -lib_cell $::env(DRIVER) [all_inputs]
foreach input [all_inputs] {
  set name [get_property $input full_name]
  set arrival [expr {[string match *read_data_o* $name] ? $::env(ACCESS) : 0}]
  if {$name ne $::env(CLOCK)} { set_input_delay $arrival -clock clock $input }
  # A reset drives many registers: it needs a tree of buffers, which synthesis does not make.
  if {$name eq "rst_ni"} { set_false_path -from $input }
}
set_output_delay 0 -clock clock [all_outputs]
set_load $::env(LOAD) [all_outputs]
