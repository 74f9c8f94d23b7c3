# Flattens down to the cells of structure.v and the gates between them.
yosys proc
yosys flatten
yosys opt_expr
yosys opt_clean
set here [file dirname [info script]]
# The cells' ports, even where none was instantiated until now.
yosys read_verilog -sv -nooverwrite -lib [file join $here structure.v]
yosys techmap -map [file join $here known_inputs.v]
yosys opt_expr
yosys opt_clean
