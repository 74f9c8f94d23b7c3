# What the lab measures: host/lab/README.md. Rows are kept in build/results/, reports written to build/reports/. An interrupted
# run goes on when it is started again.
.PHONY: stress bench variant card peers speed core scaling dates claims

comma := ,
# $(call of,PARTS): those of PARTS that were asked for; all without ONLY.
of = $(if $(ONLY),$(filter $(1),$(subst $(comma), ,$(ONLY))),$(1))
# `MPIRUN='mpirun -n 4'`: ranks share the suites of `make stress` and the sections of `make bench`.
ifdef MPIRUN
stress bench: configure += -DRAYGATE_MPI=ON
endif
define measure
@$(PYTHON) -B -m host.lab $(@:card=variant) $(if $(ONLY),--only '$(ONLY)') $(if $(QUICK),--quick) $(if $(PUBLISH),--publish) \
  $(if $(SCENES),--scenes '$(SCENES)') $(if $(RENDER),--render '$(RENDER)') $(if $(BEFORE),--before '$(BEFORE)') \
  $(if $(BASE),--base '$(BASE)') $(if $(TESTS),--tests $(TESTS)) $(if $(SEED),--seed $(SEED)) --jobs $(JOBS) \
  $(if $(MPIRUN),--launcher '$(MPIRUN)')
endef

stress: ## measure: try to make hit tests wrong: make stress [QUICK=1 ONLY=core TESTS=10000000 SEED=1 MPIRUN=]
ifdef QUICK
	$(call build,build,lab >/dev/null)
	@build/lab stress --tests 100000 --threads $(JOBS) --seed $(or $(SEED),1)
else
	@$(if $(MPIRUN),$(SETUP) mpi)
	$(call build,lab,lab $(if $(MPIRUN),share))
	$(measure)
endif

bench: ## measure: run time against error, adder to picture: make bench [QUICK=1 ONLY=lanes BASE=old.jsonl MPIRUN=]
	@$(if $(MPIRUN),$(SETUP) mpi)
	$(call build,bench,lab render scenes unit_bench $(if $(MPIRUN),share))
	$(measure)

variant_words = $(foreach word,EXP_WIDTH FRAC_WIDTH QUOTIENT_BITS ROUNDING UNIT ADDER MULTIPLIER DIVIDER_ROW ROUNDER,$(if $($(word)),$(word)=$($(word))))
# By this name, `make -n` does not run it and wait for the lock.
again := $(MAKE)
brought_words = $(filter %.sv %.v,$(variant_words))
variant: ## measure: gates to pixels of one arithmetic: make variant FRAC_WIDTH=15 [ADDER=prefix | ADDER=my.sv KEEP_GOING=1 ROUNDING=up UNIT=serial WIRES=1]
ifneq ($(brought_words),)
	@$(SETUP) lint
	@python3 -B -m synth.brought $(brought_words)
	@$(SETUP) prove
endif
	@echo 'One card: proofs of files of yours, models, tests and pictures by both, synthesis. The first takes 8 to 10 minutes on two processors, others 3 to 5.' >&2
	@$(SETUP) bench
	@$(if $(ENERGY)$(WIRES),$(SETUP) layout)
	@$(call alone,build/variant.lock,another make variant) $(again) --no-print-directory card

# Of `make variant`, one at a time: its table, its build/lab-variant and its card.
card: VARIANTS = $(CURDIR)/build/results/variant.json
card: SCENES = $(SCENE)
card: export RAYGATE_LAB = lab-variant
card:
	@$(PYTHON) -B -m host.lab.targets.variant $(if $(KEEP_GOING),--keep-going) $(variant_words)
	$(call build,bench,lab)
	$(measure) $(if $(ENERGY),--energy) $(if $(WIRES),--wires) --variant $(variant_words)

peers: ## measure: pictures next to Mitsuba 3, error against time: make peers [QUICK=1 ONLY=pictures,gltf SCENES=cornell]
	$(call build,peers,render compare scenes $(if $(call of,techniques),lab))
	$(measure)

speed: ## measure: rays/s next to Embree, exact decisions, skips, where time goes: make speed [QUICK=1 ONLY=rays,phases BEFORE=]
	$(call build,lab,scenes $(if $(call of,rays predicates),lab) $(if $(call of,skips profile phases),render compare) $(if $(call of,trace),trace))
	@$(if $(call of,skips),python3 -B scenes/make_teapot.py build/scenes/teapot_coarse.obj --fineness 3)
	$(measure)

core: ## measure: clocks of the simulated ray core: make core [QUICK=1 ONLY=scenes,wide,in-flight,exact,cores]
	$(call build,lab,lab scenes)
	$(measure)

scaling: configure += -DRAYGATE_MPI=ON
scaling: ## measure: a picture's time by ranks, and a model up to 1,000: make scaling [QUICK=1 PUBLISH=1]
	@$(SETUP) mpi
	$(call build,lab,render scenes)
	$(measure)

dates: ## measure: how old results are: make dates [RENEWED=sim/README.md: its figures are this commit's]
	@python3 -B -m host.lab.evidence $(RENEWED) || test $$? -eq 1

claims: dates everything ## measure: how old results are; figures of host/lab/claims.csv by their commands: make claims [ONLY=frame_rates]
	@python3 -B host/lab/claims.py --only '$(ONLY)'
