# Timing constraints of every design, before and after layout. CLOCK: the clock's port, or "". DRIVER: the cell that
# drives the inputs. LOAD: pF at each output. ACCESS: ns from the clock edge at which a kept memory (kept_memories.v)
# takes an address until the word is valid. The clock rate is the paper's, 10 MHz.
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
  # The reset is not timed: it drives many registers and needs a buffer tree, which synthesis does not make.
  if {$name eq "rst_ni"} { set_false_path -from $input }
}
set_output_delay 0 -clock clock [all_outputs]
set_load $::env(LOAD) [all_outputs]
