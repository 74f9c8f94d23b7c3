# A thin front: CMake does the work, in build/. `make` alone lists the targets.
JOBS ?= $(shell nproc)
SCENE ?= scenes/cornell.obj
# `make SETUP=true ...` leaves the machine's packages alone.
SETUP ?= .ci/setup

.PHONY: help verilate example render gallery frames test soak fuzz lint analyze format clean

help: ## list these targets
	@sed -nE 's/^([a-z]+):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 12

verilate: configured ## build ./render, with the simulated hardware in it, and ./compare
	@cmake --build build -j $(JOBS) --target render compare scenes

example: configured ## the paper's worked example, its words and its waveform for GTKWave
	@cmake --build build -j $(JOBS) --target worked_example
	@build/sim/worked_example --trace build/worked_example.vcd
	@echo "With the paper's divider, whose quotients have 21 bits:"
	@build/sim/worked_example --paper-divider | tail -n 1
	@echo 'Waveform: gtkwave build/worked_example.vcd sim/worked_example.gtkw'

render: verilate ## render a scene: make render SCENE=scenes/cornell.obj ARGS='--size 640x480'
	./render $(SCENE) $(ARGS)

gallery: verilate ## render the pictures of the gallery again, each by the command beside it
	@sed -nE 's|.*`(./render [^`]*scenes/gallery/[^`]*)`.*|\1|p' scenes/README.md | \
	  while read -r command; do echo "$$command"; $$command --quiet || exit 1; done

frames: verilate ## the paper's frame: clocks, and frames a second at 10 MHz, for 1 to 10 lanes
	@python3 sim/bench/frame_rates.py ./render scenes/paper.obj

test: everything ## build and run all tests, lint among them
	@ctest --test-dir build -j $(JOBS) --output-on-failure --no-tests=error

soak: everything ## ten million tests of the pipelined unit with each number of lanes
	@RAYGATE_STRESS=10000000 build/sim/rtl_burst_unit_test

FUZZ_SECONDS ?= 60
fuzz: ## libFuzzer on the scene loader and on exact arithmetic: make fuzz [FUZZ_SECONDS=60]
	@$(SETUP) fuzz
	@cmake -S . -B build/fuzz -G Ninja -DCMAKE_CXX_COMPILER=clang++ -DBUILD_TESTING=OFF -DRAYGATE_FUZZ=ON
	@cmake --build build/fuzz -j $(JOBS) --target obj_fuzz exact_fuzz
	@mkdir -p build/fuzz/scenes && cp -n scenes/cornell.obj scenes/paper.obj build/fuzz/scenes
	@build/fuzz/obj_fuzz -max_total_time=$(FUZZ_SECONDS) -artifact_prefix=build/fuzz/ build/fuzz/scenes
	@build/fuzz/exact_fuzz -max_total_time=$(FUZZ_SECONDS) -artifact_prefix=build/fuzz/

lint: everything ## check style and pitfalls of all sources
	@ctest --test-dir build --output-on-failure --no-tests=error -R '^lint\.'

analyze: everything ## clang's static analyser over all sources: minutes
	@.ci/lint analyze

format: ## lay all sources out as lint wants them
	@$(SETUP) test
	@.ci/lint format --fix

clean: ## remove what was built (scenes and pictures stay)
	rm -rf build render compare

.PHONY: configured everything
configured:
	@$(SETUP) build
	@test -f build/build.ninja || cmake -S . -B build -G Ninja -DBUILD_TESTING=OFF

everything:
	@$(SETUP) test
	@cmake -S . -B build -G Ninja -DBUILD_TESTING=ON
	@cmake --build build -j $(JOBS)

include synth/synth.mk
include host/lab/rays/rays.mk
include host/lab/bench.mk
include host/lab/skips/skips.mk
include host/lab/stress/stress.mk
