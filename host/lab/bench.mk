# `make bench`: see host/lab/README.md.
BENCH_PYTHON := build/venv/bin/python3

.PHONY: bench

bench: ## run time against error, one report: make bench [QUICK=1 BASE=old.json]
	@$(SETUP) bench
	@test -f build/build.ninja || cmake -S . -B build -G Ninja -DBUILD_TESTING=ON
	@cmake --build build -j $(JOBS) --target \
	  picture_bench unit_bench compare table_1 worked_example scenes
	@$(BENCH_PYTHON) -m host.lab.matrix $(if $(QUICK),--quick) $(if $(BASE),--base '$(BASE)') \
	  $(if $(PUBLISH),--publish)
