# `make stress`: engines and cheaper variants against exact integers. QUICK=1: under a minute, one
# line. TESTS: of the cpu engines for each suite, a tenth of it by the simulated ones.
TESTS ?= 10000000
STRESS_REPORT := build/stress

.PHONY: stress

stress: ## try to make the hit tests wrong: make stress [QUICK=1 TESTS=10000000 SEED=1]
	@$(SETUP) build
	@test -f build/build.ninja || cmake -S . -B build -G Ninja -DBUILD_TESTING=OFF
	@cmake --build build -j $(JOBS) --target stress $(if $(QUICK),>/dev/null)
ifdef QUICK
	@build/stress --quiet --tests 100000 --threads $(JOBS) --seed $(or $(SEED),1)
else
	@test -x build/synth/venv/bin/python3 || $(MAKE) build/synth/venv/ready
	@mkdir -p $(STRESS_REPORT)
	@build/stress --tests $(TESTS) --threads $(JOBS) --seed $(or $(SEED),1) \
	  --json $(STRESS_REPORT)/run.json; status=$$?; \
	build/synth/venv/bin/python3 host/bench/stress/report.py $(STRESS_REPORT)/run.json \
	  $(STRESS_REPORT) build/synth/results.json && \
	echo 'Report: $(STRESS_REPORT)/report.md'; exit $$status
endif
