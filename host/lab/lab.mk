# What the lab measures: host/lab/README.md. Rows are kept in build/results/, reports written to build/reports/. An interrupted
# run goes on when it is started again.
.PHONY: stress bench variant card peers speed core

comma := ,
# $(call of,PARTS): those of PARTS that were asked for; all without ONLY.
of = $(if $(ONLY),$(filter $(1),$(subst $(comma), ,$(ONLY))),$(1))
define measure
@$(PYTHON) -B -m host.lab $(@:card=variant) $(if $(ONLY),--only '$(ONLY)') $(if $(QUICK),--quick) $(if $(PUBLISH),--publish) \
  $(if $(SCENES),--scenes '$(SCENES)') $(if $(RENDER),--render '$(RENDER)') $(if $(BEFORE),--before '$(BEFORE)') \
  $(if $(TESTS),--tests $(TESTS)) $(if $(SEED),--seed $(SEED)) --jobs $(JOBS)
endef

stress: ## measure: try to make hit tests wrong: make stress [QUICK=1 ONLY=core TESTS=10000000 SEED=1]
ifdef QUICK
	$(call build,build,lab >/dev/null)
	@build/lab stress --tests 100000 --threads $(JOBS) --seed $(or $(SEED),1)
else
	$(call build,lab,lab)
	$(measure)
endif

bench: ## measure: run time against error, adder to picture: make bench [QUICK=1 ONLY=lanes]
	$(call build,bench,lab scenes unit_bench)
	$(measure)

# In quotes: names of files may hold blanks.
variant_words = $(foreach word,EXP_WIDTH FRAC_WIDTH QUOTIENT_BITS ROUNDING UNIT ADDER MULTIPLIER DIVIDER_ROW ROUNDER,$(if $($(word)),'$(word)=$(subst ','\'',$($(word)))'))
# By this name, `make -n` does not run it and wait for the lock.
again := $(MAKE)
variant: ## measure: gates to pixels of one arithmetic: make variant FRAC_WIDTH=15 [ADDER=prefix | ADDER=my.sv KEEP_GOING=1 ROUNDING=up UNIT=serial WIRES=1]
ifneq ($(filter %.sv' %.v',$(variant_words)),)
	@$(SETUP) lint
	@$(PYTHON) -B -m synth.brought $(variant_words)
	@$(SETUP) prove
endif
	@echo 'One card: proofs of files of yours, models, tests and pictures by both, synthesis. The first takes 8 to 10 minutes on two processors, others 3 to 5.' >&2
	@$(SETUP) bench
	@$(if $(ENERGY)$(WIRES),$(SETUP) layout)
	@$(call alone,build/variant.lock,another make variant) $(again) --no-print-directory card

# The rest of `make variant`, one run at a time: writes its table of variants, builds build/lab-variant, prints the card.
card: VARIANTS = $(CURDIR)/build/results/variant.json
card: SCENES = $(SCENE)
card: export RAYGATE_LAB = lab-variant
card:
	@$(PYTHON) -B -m host.lab.targets.variant $(if $(KEEP_GOING),--keep-going) $(variant_words)
	$(call build,bench,lab)
	$(measure) $(if $(ENERGY),--energy) $(if $(WIRES),--wires) --variant $(variant_words)

peers: ## measure: pictures next to Mitsuba 3, error against time: make peers [QUICK=1 SCENES=cornell]
	$(call build,peers,render compare scenes)
	$(measure)

speed: ## measure: rays/s next to Embree, exact decisions, skips, where time goes: make speed [QUICK=1 ONLY=rays,phases BEFORE=]
	$(call build,lab,scenes $(if $(call of,rays predicates),lab) $(if $(call of,skips profile phases),render compare) $(if $(call of,trace),trace))
	@$(if $(call of,skips),python3 -B scenes/make_teapot.py build/scenes/teapot_coarse.obj --fineness 3)
	$(measure)

core: ## measure: clocks of the simulated ray core: make core [QUICK=1 ONLY=scenes,wide,in-flight,exact,cores]
	$(call build,lab,lab scenes)
	$(measure)
