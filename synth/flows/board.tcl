# Maps a board's top, its own clock and pins in it, to an ECP5: SOURCES, TOP, OUT (the netlist for nextpnr).
yosys -import
yosys read_verilog -sv -defer -DSYNTHESIS {*}$::env(SOURCES)
yosys synth_ecp5 -abc9 -top $::env(TOP) -json $::env(OUT)
