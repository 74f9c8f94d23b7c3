# Makes the module opened_NAME of module NAME: the same, flat, with inner wires as outputs. For
# invariants, which speak of what is inside.
#   RTL       the sources
#   PREPARED  NAME, its parameters and their values, the wires, in Yosys's patterns, and memories,
#             each as its name, depth and width: all words are one output, word 0 lowest
lassign $::env(PREPARED) name parameters wires memories
yosys read_verilog -formal -sv -defer {*}$::env(RTL)
# `hierarchy -chparam` stops at modules with an unsized constant at a cell's port.
foreach {parameter value} $parameters { yosys chparam -set $parameter $value \$abstract\\$name }
yosys hierarchy -check -top $name
yosys proc
yosys flatten
yosys rename -top opened_$name
yosys cd opened_$name
foreach wire $wires { yosys expose w:$wire }
yosys opt_reduce  ;# one enable for all bits of a word
yosys memory -nordff  ;# a register of an address stays one of its own
yosys opt_clean
foreach {memory depth width} $memories {
  set words {}
  for {set n 0} {$n < $depth} {incr n} { set words [linsert $words 0 \\${memory}\[$n\]] }
  set port [string map {. _} $memory]
  yosys add -output $port [expr {$depth * $width}]
  yosys connect -set $port [join $words ,]
}
yosys cd ..
