# Area, time, proofs: see synth/README.md.
SYNTH_JOBS ?= 2
SYNTH_BUDGET ?= 16

.PHONY: synth cells prove refute verilog fpga datasheet layout energy floorplan

# The whole report has tests a second in it, which programs count.
synth: $(if $(TOP),,verilate) ## area and time: make synth [TOP=adder ADDER=graded GROUPS=4,5,7 WIDTH=48 TARGETS=osu035 ...]
	@$(SETUP) synth
	$(if $(TOP),,$(call build,build,table_1 worked_example))
	@$(PYTHON) -m synth --top '$(TOP)' --adder '$(ADDER)' --width '$(WIDTH)' \
	  --groups '$(GROUPS)' --look-ahead '$(LOOK_AHEAD)' --exp-width '$(EXP_WIDTH)' \
	  --frac-width '$(FRAC_WIDTH)' --targets '$(TARGETS)' --budget '$(SYNTH_BUDGET)' \
	  --jobs '$(SYNTH_JOBS)'

cells: ## characterise SkyWater 130 cells with ngspice, and how far they are from published figures: make cells [CORNERS=tt,ss,ff]
	@$(SETUP) synth
	@$(PYTHON) -m synth.cells --corners '$(CORNERS)' --jobs '$(SYNTH_JOBS)'

prove: ## prove adders, multiplier, float cores, units, netlists: make prove [PROOFS='adder. float.add'] [LONG=1] [KEPT=1] [RECORD=1]
	@$(SETUP) prove
	@$(PYTHON) -m synth.prove --jobs '$(SYNTH_JOBS)' $(if $(LONG),--long) $(if $(RECORD),--record) $(if $(KEPT),--kept) $(PROOFS)

refute: ## faults in the float cores, refuted: make refute [CORES='add divide'] [FAULTS=80]
	@$(SETUP) prove
	$(call build,test,check_vectors)
	@$(PYTHON) -m synth.float_faults --count $(or $(FAULTS),80) $(CORES)

verilog: ## a module as one file of plain Verilog: make verilog TOP=fp_adder_stages [PARAMS='ExpWidth=5 FracWidth=10']
	@$(SETUP) synth
	@$(PYTHON) -m synth.verilog "$(TOP)" "$(PARAMS)"

fpga: ## place and route the units on FPGAs, an hour or two: make fpga [UNITS=hit_test_unit-binary32] [SEEDS=3]
	@$(SETUP) synth
	@$(PYTHON) -m synth.fpga $(if $(SEEDS),--seeds $(SEEDS)) $(UNITS)

datasheet: ## fill hw/README.md from the sources and from what synth and fpga measured, draw its diagrams
	$(call build,build,worked_example)
	@$(SETUP) synth
	@$(PYTHON) -m synth.datasheet

layout: ## place, route, time with wires and draw: make layout [TOP=adders|multipliers|cores|a module ...] [SEEDS=3] [TARGETS=osu018] [DENSITY=0.8 ASPECT=2 FLOW=fast]
	@$(SETUP) layout
	@$(PYTHON) -m synth.layout --top '$(TOP)' --adder '$(ADDER)' --width '$(WIDTH)' \
	  --groups '$(GROUPS)' --look-ahead '$(LOOK_AHEAD)' --exp-width '$(EXP_WIDTH)' \
	  --frac-width '$(FRAC_WIDTH)' --targets '$(TARGETS)' --flow '$(FLOW)' --density '$(DENSITY)' --aspect '$(ASPECT)' --seeds '$(SEEDS)' \
	  --jobs '$(SYNTH_JOBS)'

energy: ## energy of a test in each format, from timed gate-level simulation of real operands; make bench takes it from here
	@$(SETUP) layout
	@$(PYTHON) -m synth.layout.formats

floorplan: ## where nextpnr puts a unit on an FPGA, and its slowest path: make floorplan [UNITS=hit_test_unit-binary32-behavioural]
	@$(SETUP) synth
	@$(PYTHON) -m synth.floorplan $(UNITS)
