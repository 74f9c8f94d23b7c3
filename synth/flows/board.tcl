# Maps a board's top, its own clock and pins in it, to an ECP5: SOURCES, TOP, OUT (the netlist for nextpnr).
yosys -import
yosys read_verilog -sv -defer -DSYNTHESIS {*}$::env(SOURCES)
# LUT4s alone: those of five inputs and more are pairs that take each input twice, which the router has no wires for.
yosys synth_ecp5 -abc9 -nowidelut -top $::env(TOP) -json $::env(OUT)
