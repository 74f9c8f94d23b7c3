# Reads the routed layout, extracts its capacitances to TOP.ext and writes TOP.gds.
#   LEF, DEF, TOP. In GDS the cells are what LEF says of them: pins and obstructions.
drc off
lef read $::env(LEF)
def read $::env(DEF) -labels
load $::env(TOP)
select top cell
extract all
gds write $::env(TOP).gds
quit -noprompt
