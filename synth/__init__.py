"""What each adder, core and unit of hw/ costs, measured with Yosys, ABC, OpenSTA and nextpnr."""
