# Makes the module "assembly" of booth_multiplier: what it does between the recoded digits and the
# tree. The digits' signs and the rows become inputs, the words for the tree an output.
#   RTL, PREPARED  the sources of the multiplier and its parameters
yosys read_verilog -sv -defer {*}$::env(RTL)
yosys hierarchy -check -top booth_multiplier {*}$::env(PREPARED)
yosys proc
yosys rename -top assembly
yosys expose -input assembly/w:negative assembly/w:gen_row*.row
yosys delete assembly/u_encoder assembly/u_tree assembly/u_adder assembly/gen_row*.u_row
yosys delete -port assembly/w:a_i assembly/w:b_i assembly/w:product_o
yosys expose assembly/w:rows
yosys opt_clean -purge assembly
