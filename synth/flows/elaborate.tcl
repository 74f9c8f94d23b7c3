# Reads SOURCES and elaborates TOP with PARAMETERS ("Name value Name value ...").
# -defer: a module is built when it is asked for, with its parameters, and not before.
yosys read_verilog -sv -defer -DSYNTHESIS {*}$::env(SOURCES)
set overrides {}
foreach {name value} $::env(PARAMETERS) { lappend overrides -chparam $name $value }
yosys hierarchy -check -top $::env(TOP) {*}$overrides
# CUT: an instance that is left out; its ports become the design's. TIED: ports held at constants
# ("port value ...").
if {$::env(CUT) ne ""} {
  yosys proc
  yosys expose -evert $::env(TOP)/$::env(CUT)
}
if {$::env(TIED) ne ""} {
  yosys cd $::env(TOP)
  foreach {port value} $::env(TIED) {
    yosys delete -port w:$port
    yosys connect -set $port $value
  }
  yosys cd
}
