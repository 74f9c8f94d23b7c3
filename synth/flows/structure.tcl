# Flattens down to the cells of structure.v and the gates between them.
yosys proc
yosys flatten
yosys opt_expr
yosys opt_clean
yosys techmap -map [file join [file dirname [info script]] known_selects.v]
yosys opt_expr
yosys opt_clean
