# Area, time, proofs: see synth/README.md.
SYNTH_JOBS ?= 2

.PHONY: synth prove verilog fpga datasheet lecture layout

# What describes one design says nothing without it.
ifneq ($(filter synth layout,$(MAKECMDGOALS)),)
ifeq ($(filter-out adders float_peers multipliers cores energy,$(TOP)),)
$(foreach name,$(filter ADDER WIDTH GROUPS LOOK_AHEAD EXP_WIDTH FRAC_WIDTH EXACT,$(given)),$(error $(name): expected TOP, too, the module that has it))
endif
endif

# The whole report has tests a second in it, which programs count.
synth: $(if $(filter-out 0,$(ALL)),verilate) ## hardware: area and time: make synth [ALL=1] [TOP=adder ADDER=graded GROUPS=4,5,7 WIDTH=48 TARGETS=osu035 LIBERTY=cells.lib ...]
	@$(SETUP) synth
	@$(if $(filter float_peers,$(TOP)),$(SETUP) lab)
	$(if $(filter-out 0,$(ALL)),$(call build,build,table_1 worked_example))
	@$(PYTHON) -m synth --top '$(TOP)' --adder '$(ADDER)' --width '$(WIDTH)' \
	  --groups '$(GROUPS)' --look-ahead '$(LOOK_AHEAD)' --exp-width '$(EXP_WIDTH)' \
	  --frac-width '$(FRAC_WIDTH)' --exact '$(EXACT)' --targets '$(TARGETS)' --liberty '$(LIBERTY)' --all '$(filter-out 0,$(ALL))' \
	  --jobs '$(SYNTH_JOBS)'

prove: ## hardware: prove arithmetic, units, netlists: make prove [PROOFS='adder. float.add' LONG=1 KEPT=1 RECORD=1]
	@$(SETUP) prove
	@$(PYTHON) -m synth.prove --jobs '$(SYNTH_JOBS)' $(if $(LONG),--long) $(if $(RECORD),--record) $(if $(KEPT),--kept) $(PROOFS)

verilog: ## hardware: a module in one file of plain Verilog: make verilog TOP=fp_adder_stages [PARAMS='ExpWidth=5']
	@$(SETUP) synth
	@$(PYTHON) -m synth.verilog "$(TOP)" "$(PARAMS)"

fpga: ## hardware: place and route on FPGAs: make fpga [UNITS=hit_test_unit-binary32 SEEDS=3] [TOP=small_core BOARD=ulx3s: a bitstream]
	@$(SETUP) synth
ifdef BOARD
	@$(PYTHON) -m synth.board '$(TOP)' '$(BOARD)' $(if $(SEEDS),--seed $(SEEDS))
else
	@$(PYTHON) -m synth.fpga $(if $(SEEDS),--seeds $(SEEDS)) $(UNITS)
endif

datasheet: ## hardware: the table of modules and the diagrams of hw
	$(call build,build,worked_example)
	@$(SETUP) synth
	@$(PYTHON) -m synth.datasheet

lecture: ## hardware: a page of adders with numbers in them: make lecture [WIDTH=12 GROUPS=3,4,5 A=1365 B=2731 X=1.5 Y=-0.3]
	@$(SETUP) synth
	@$(PYTHON) -m synth.lecture --width '$(WIDTH)' --groups '$(GROUPS)' --a '$(A)' --b '$(B)' --carry '$(CARRY)' --x '$(X)' --y '$(Y)'

layout: ## hardware: place, route, time, draw: make layout [TOP=adders | multipliers | cores | MODULE | energy SEEDS=3]
	@$(SETUP) layout
ifeq ($(TOP),energy)
	@$(PYTHON) -m synth.layout.formats
else
	@$(PYTHON) -m synth.layout --top '$(TOP)' --adder '$(ADDER)' --width '$(WIDTH)' \
	  --groups '$(GROUPS)' --look-ahead '$(LOOK_AHEAD)' --exp-width '$(EXP_WIDTH)' \
	  --frac-width '$(FRAC_WIDTH)' --targets '$(TARGETS)' --flow '$(FLOW)' --density '$(DENSITY)' --aspect '$(ASPECT)' --seeds '$(SEEDS)' \
	  --jobs '$(SYNTH_JOBS)'
endif
