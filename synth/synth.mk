# Area, time, proofs: see synth/README.md. Two jobs run at once unless JOBS is set: a core takes a gigabyte.
SYNTH_JOBS ?= $(if $(filter file,$(origin JOBS)),2,$(JOBS))

.PHONY: synth prove fpga lecture layout

# $(call options,...): command-line options for those of the listed variables that are set: --width='48' for WIDTH=48.
options = $(foreach name,$(1),$(if $($(name)),--$(subst _,-,$(name))='$($(name))'))

design_words = TOP ADDER WIDTH GROUPS LOOK_AHEAD EXP_WIDTH FRAC_WIDTH EXACT TARGETS PUBLISH

# Options for a single design need TOP. PARAMS needs VERILOG.
ifneq ($(and $(PARAMS),$(if $(VERILOG),,1)),)
$(error PARAMS: expected VERILOG=1, too)
endif
ifneq ($(filter synth layout,$(MAKECMDGOALS)),)
ifeq ($(filter-out adders float_peers multipliers cores unit,$(TOP)),)
$(foreach name,$(filter ADDER WIDTH GROUPS LOOK_AHEAD EXP_WIDTH FRAC_WIDTH EXACT VERILOG,$(given)),$(error $(name): expected TOP, too, the module that has it))
endif
endif

synth: ## hardware: area and time: make synth [ALL=1 PUBLISH=1 | TOP=adder ADDER=graded GROUPS=4,5,7 WIDTH=48 TARGETS=osu035 LIBERTY=cells.lib ... | TOP=fp_adder VERILOG=1: one file of plain Verilog | DATASHEET=1: hw/modules.md]
	@$(SETUP) synth
	@$(if $(filter float_peers,$(TOP)),$(SETUP) lab,$(if $(filter %.sv,$(ADDER)),$(SETUP) lint))
ifdef DATASHEET
	@$(PYTHON) -m synth.datasheet
else ifdef VERILOG
	@$(PYTHON) -m synth.verilog "$(TOP)" "$(PARAMS)"
else
	@$(PYTHON) -m synth $(call options,$(design_words) LIBERTY) $(if $(filter-out 0,$(ALL)),--all 1) --jobs $(SYNTH_JOBS)
endif

prove: ## hardware: prove arithmetic, units, netlists: make prove [PROOFS='adder. float.add' LONG=1 KEPT=1 PUBLISH=1]
	@$(SETUP) prove
	@$(PYTHON) -m synth.prove --jobs '$(SYNTH_JOBS)' $(if $(LONG),--long) $(if $(PUBLISH),--publish) $(if $(KEPT),--kept) $(PROOFS)

fpga: ## hardware: place and route on FPGAs: make fpga [UNITS=hit_test_unit-binary32 SEEDS=3 PUBLISH=1] [TOP=small_core BOARD=ulx3s: a bitstream]
	@$(SETUP) synth
ifdef BOARD
	@$(PYTHON) -m synth.board '$(TOP)' '$(BOARD)' $(if $(SEEDS),--seed $(SEEDS))
else
	@$(PYTHON) -m synth.fpga --jobs $(SYNTH_JOBS) $(if $(SEEDS),--seeds $(SEEDS)) $(if $(PUBLISH),--publish) $(UNITS)
endif

lecture: ## hardware: numbers in gates, a page: make lecture [WIDTH=12 GROUPS=3,4,5 A=1365 B=2731 X=1.5 Y=-0.3 | EXAMPLE=1: the paper's, clock by clock | PIXEL=64,64 SCENE= ARGS=: its ray in the ray core]
ifdef EXAMPLE
	$(foreach name,$(filter WIDTH GROUPS A B CARRY X Y PIXEL ARGS,$(given)),$(error $(name): EXAMPLE=1 takes the paper's numbers; make page takes others))
	$(call build,build,worked_example)
	@build/sim/worked_example --trace build/worked_example.vcd
	@echo "With the paper's divider, whose quotients have 21 bits:"
	@build/sim/worked_example --paper-divider | tail -n 1
	@echo 'Waveform: gtkwave build/worked_example.vcd sim/worked_example.gtkw'
else ifdef PIXEL
	$(call build,build,render)
	@./render $(SCENE) --unit core --size 128x128 $(ARGS) --trace $(PIXEL)=build/pixel.vcd
	@echo 'Waveform: gtkwave build/pixel.vcd sim/ray_core.gtkw'
else
	@$(SETUP) synth
	@$(PYTHON) -m synth.lecture $(call options,WIDTH GROUPS A B CARRY X Y)
endif

layout: ## hardware: place, route, time, draw: make layout [TOP=adders | multipliers | cores | unit | MODULE SEEDS=3 | PUBLISH=1]
	@$(SETUP) layout$(if $(filter %.sv,$(ADDER)), && $(SETUP) lint)
	@$(PYTHON) -m synth.layout $(call options,$(design_words) FLOW DENSITY ASPECT SEEDS) --jobs $(SYNTH_JOBS)
