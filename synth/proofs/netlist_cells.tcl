# Writes the library's combinational cells and flip-flops as Verilog (from the functions that the
# library states), and the netlist of TOP under the name "netlist".
#   LIBERTY, NETLIST, TOP; OUT  folder of cells.v, netlist.v, netlist.json
yosys -import
yosys read_liberty -ignore_miss_func -ignore_miss_dir -ignore_miss_data_latch $::env(LIBERTY)
yosys delete LATCH TBUFX1 TBUFX2 PAD*
yosys proc
yosys write_verilog -noattr [file join $::env(OUT) cells.v]
yosys design -reset
yosys read_verilog $::env(NETLIST)
yosys rename $::env(TOP) netlist
yosys write_json [file join $::env(OUT) netlist.json]
yosys write_verilog -noattr -noexpr [file join $::env(OUT) netlist.v]
