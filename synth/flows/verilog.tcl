# Writes TOP, with PARAMETERS and all that it instantiates, as one file of plain Verilog: OUT.
yosys -import
# Not elaborate.tcl, whose hierarchy -chparam stops at modules with an unsized constant at a cell's port. (Names of cells that
# chparam leaves change what ABC makes of a netlist, by up to 5 %: the measured flows keep theirs.)
yosys read_verilog -sv -defer -DSYNTHESIS {*}$::env(SOURCES)
foreach {name value} $::env(PARAMETERS) { yosys chparam -set $name $value \$abstract\\$::env(TOP) }
yosys hierarchy -check -top $::env(TOP)
yosys proc
yosys opt_expr
yosys opt_clean
yosys rename -top $::env(TOP)
yosys write_verilog -noattr $::env(OUT)
