# `make synth`, `make prove` and `make verilog`: see synth/README.md.
SYNTH_PYTHON := build/synth/venv/bin/python3
SYNTH_JOBS ?= 2
SYNTH_BUDGET ?= 16

.PHONY: synth prove verilog

synth: build/synth/venv/ready ## area and time: make synth [TOP=adder ADDER=graded GROUPS=4,5,7 WIDTH=48 TARGETS=osu035 ...]
	@$(SYNTH_PYTHON) -m synth --top '$(TOP)' --adder '$(ADDER)' --width '$(WIDTH)' \
	  --groups '$(GROUPS)' --look-ahead '$(LOOK_AHEAD)' --exp-width '$(EXP_WIDTH)' \
	  --frac-width '$(FRAC_WIDTH)' --targets '$(TARGETS)' --budget '$(SYNTH_BUDGET)' \
	  --jobs '$(SYNTH_JOBS)'

build/synth/venv/ready: synth/requirements.txt
	@echo 'Installing into build/synth/venv what synth/requirements.txt lists'
	@python3 -m venv --clear build/synth/venv || \
	  { echo 'sudo apt-get install python3-venv' >&2; exit 2; }
	@build/synth/venv/bin/pip install -q --disable-pip-version-check -r $<
	@touch $@

prove: ## prove adders, multiplier and timetable: make prove [PROOFS='adder. booth.tree']
	@python3 -m synth.prove --jobs '$(SYNTH_JOBS)' $(PROOFS)

verilog: ## a module as one file of plain Verilog: make verilog TOP=fp_adder_stages [PARAMS='ExpWidth=5 FracWidth=10']
	@python3 -m synth.verilog "$(TOP)" "$(PARAMS)"
