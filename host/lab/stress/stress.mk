# `make stress`: engines and cheaper variants against exact integers. QUICK=1: under a minute, one
# line. TESTS: of the cpu engine for each suite, half of it in place, a tenth by the simulated ones.
TESTS ?= 10000000
STRESS_RESULTS := build/stress_report

.PHONY: stress

# An interrupted run goes on where it was: the suites that are done are in $(STRESS_RESULTS).
stress: ## try to make the hit tests wrong: make stress [QUICK=1 TESTS=10000000 SEED=1]
	@$(SETUP) $(if $(QUICK),build,synth)
	$(call build,build,stress $(if $(QUICK),>/dev/null))
ifdef QUICK
	@build/stress --quiet --tests 100000 --threads $(JOBS) --seed $(or $(SEED),1)
else
	@build/stress --tests $(TESTS) --threads $(JOBS) --seed $(or $(SEED),1) \
	  --results $(STRESS_RESULTS); status=$$?; \
	$(PYTHON) host/lab/stress/report.py $(STRESS_RESULTS) \
	  --synth build/synth/results.json --readme host/lab/stress/README.md && \
	echo 'Report: $(STRESS_RESULTS)/report.md'; exit $$status
endif

.PHONY: predicates doubts

predicates: ## what an exact decision costs, beside rationals and __float128
	$(call build,build,predicate_bench)
	@build/predicate_bench

doubts: verilate ## doubts and their share of the time, scene by scene
	@cmake --build build -j $(JOBS) --target scenes
	@python3 host/lab/stress/doubts.py scenes/*.obj build/scenes/*.obj
