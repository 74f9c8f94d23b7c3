# Puts FAULTS single faults into NETLIST, chosen from SEED and spread evenly: number k, counted from 1, is
# there where the new input fault_i is k. Writes the list of them to LIST and the module to SMT2.
yosys -import
yosys read_rtlil $::env(NETLIST)
yosys mutate -list $::env(FAULTS) -seed $::env(SEED) -ctrl fault_i 8 1 -o $::env(LIST)
yosys script $::env(LIST)
yosys opt_clean
yosys write_smt2 -stbv -wires $::env(SMT2)
