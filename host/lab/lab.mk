# Measurements of the lab (see host/lab/README.md). Rows are in build/results/, reports in build/reports/. Starting an
# interrupted run again continues it.
.PHONY: stress bench variant card peers speed

# The command in a report: as typed, without variables that change no row.
typed = make $(MAKECMDGOALS:card=variant) $(foreach name,$(filter-out PUBLISH JOBS SETUP UNITY,$(given)),$(name)=$($(name)))
define measure
@$(PYTHON) -B -m host.lab $(or $(lab_target),$(@:card=variant) $(if $(ONLY),--only '$(ONLY)')) $(if $(QUICK),--quick) $(if $(PUBLISH),--publish) \
  --jobs $(JOBS) --command '$(subst ','\'',$(typed))'
endef

stress: ## measure: try to make hit tests wrong: make stress [QUICK=1 ONLY=core TESTS=10000000 SEED=1]
	$(call build,lab,lab)
	$(measure) $(if $(TESTS),--tests $(TESTS)) $(if $(SEED),--seed $(SEED))

bench: lab_target = $(filter core,$(ONLY))
bench: ## measure: run time against error, by arithmetic, engine, lanes: make bench [QUICK=1 ONLY=lanes | ONLY=core: clocks of the simulated ray core]
	$(call build,$(if $(filter core,$(ONLY)),lab,bench),lab scenes render)
	$(measure)

# Words are quoted, as file names may contain spaces.
variant_words = $(foreach word,EXP_WIDTH FRAC_WIDTH QUOTIENT_BITS ROUNDING UNIT ADDER MULTIPLIER DIVIDER_ROW ROUNDER,$(if $($(word)),'$(word)=$(subst ','\'',$($(word)))'))
# Not $(MAKE), which `make -n` would run, and then wait for the lock.
again := $(MAKE)
variant: ## measure: gates to pixels of one arithmetic: make variant FRAC_WIDTH=15 [ADDER=prefix | ADDER=my.sv KEEP_GOING=1 ROUNDING=up UNIT=serial]
ifneq ($(filter %.sv' %.v',$(variant_words)),)
	@$(SETUP) lint
	@$(PYTHON) -B -m synth.brought $(variant_words)
	@$(SETUP) prove
endif
	@echo 'One card: proofs of files of yours, models, tests and pictures by both, synthesis. The first takes 8 to 10 minutes on two processors, others 3 to 5.' >&2
	@$(SETUP) bench
	@$(call alone,build/variant.lock,another make variant) $(again) --no-print-directory card

# The other steps of `make variant`, one run at a time: write its table of variants, build build/lab-variant, print the card.
card: VARIANTS = $(CURDIR)/build/results/variant.json
card: export RAYGATE_LAB = lab-variant
card:
	@$(PYTHON) -B -m host.lab.targets.variant $(if $(KEEP_GOING),--keep-going) $(variant_words)
	$(call build,bench,lab)
	$(measure) $(if $(SCENE),--scenes '$(SCENE)') --variant $(variant_words)

peers: ## measure: pictures next to Mitsuba 3, error against time: make peers [QUICK=1 SCENES=cornell]
	$(call build,peers,render scenes)
	$(measure) $(if $(SCENES),--scenes '$(SCENES)')

speed: ## measure: rays per second next to Embree: make speed [QUICK=1]
	$(call build,lab,scenes lab)
	$(measure)
