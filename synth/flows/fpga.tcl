# Maps one design to an FPGA: FAMILY ice40 | ecp5. In two steps, for a design without a clock:
#   PORTS    only elaborate, and write the ports as JSON to this file
#   WRAPPER  file of the module "registered", which puts registers around TOP
#   LUTS     options of which LUTs to take
#   OUT      the netlist for nextpnr
yosys -import
source [file join [file dirname [info script]] elaborate.tcl]
if {$::env(PORTS) ne ""} {
  yosys proc
  yosys write_json $::env(PORTS)
  exit
}
set top $::env(TOP)
if {$::env(WRAPPER) ne ""} {
  # The elaborated module takes the plain name that the wrapper instantiates.
  yosys proc
  yosys flatten
  yosys rename -top $::env(TOP)
  yosys read_verilog $::env(WRAPPER)
  set top registered
}
yosys synth_$::env(FAMILY) -abc9 {*}$::env(LUTS) -top $top -json $::env(OUT)
