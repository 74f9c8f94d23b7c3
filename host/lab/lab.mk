# What the lab measures: see host/lab/README.md. Each target keeps its rows in build/results/.
LAB := build/lab
LAB_ROWS := build/results
LAB_REPORT := $(PYTHON) -m host.lab.report
GALLERY := scenes/cornell.obj scenes/teapot.obj $(wildcard scenes/*_*.json) scenes/columns.json scenes/sphereflake.json
LARGE_SCENES := build/scenes/sphere.obj build/scenes/sphereflake.obj
# `make stress`: tests by the cpu engine in each suite; others do their share of it.
TESTS ?= 10000000

# `make stress MPIRUN='mpirun -n 4'`: ranks share the suites, and of `make bench` the sections.
define share
$(if $(MPIRUN),@$(SETUP) mpi && $(configure) -DRAYGATE_MPI=ON >/dev/null && cmake --build build -j $(JOBS) --target share)
endef

.PHONY: stress stress-core bench peers gltf-pictures rays core skips predicates techniques profile phase-times scaling adaptive coverage trace-rates claims

# An interrupted run goes on where it was: the suites that are done are in $(LAB_ROWS)/stress.jsonl.
stress: ## try to make the hit tests wrong: make stress [QUICK=1 TESTS=10000000 SEED=1 MPIRUN='mpirun -n 4' PUBLISH=1]
ifdef QUICK
	$(call build,build,lab >/dev/null)
	@$(LAB) stress --quiet --tests 100000 --threads $(JOBS) --seed $(or $(SEED),1)
else
	$(call build,lab,lab)
	$(share)
	@$(if $(MPIRUN),$(LAB_REPORT) share-stress --tests $(TESTS) --seed $(or $(SEED),1) --launcher '$(MPIRUN)')
	@$(LAB) --results $(LAB_ROWS)/stress.jsonl stress --tests $(TESTS) --threads $(JOBS) \
	  --seed $(or $(SEED),1); status=$$?; \
	$(LAB_REPORT) stress $(if $(PUBLISH),--publish) && exit $$status
endif

# 500,000 tests a suite by the reference model, 50,000 by the simulated hardware; goes on where it was.
stress-core: ## the ray core alone under stress: ten million tests by its reference model, one million simulated
	$(call build,build,lab)
	@$(LAB) --results $(LAB_ROWS)/stress-core.jsonl stress --subject 'model core' 'rtl core' \
	  --tests 2500000 --threads $(JOBS) --seed $(or $(SEED),1)

bench: ## run time against error, one report: make bench [QUICK=1 BASE=old.jsonl MPIRUN='mpirun -n 4' PUBLISH=1]
	$(call build,bench,lab render scenes unit_bench table_1 worked_example)
	$(share)
	@$(LAB_REPORT) bench $(if $(QUICK),--quick) $(if $(BASE),--base '$(BASE)') \
	  $(if $(MPIRUN),--launcher '$(MPIRUN)') $(if $(PUBLISH),--publish)

peers: ## error against time next to Mitsuba 3: make peers [QUICK=1 SCENES='cornell teapot' PUBLISH=1]
	$(call build,peers,render scenes)
	@$(PYTHON) -B -m host.lab.peers $(SCENES) $(if $(QUICK),--quick) $(if $(PUBLISH),--publish)

gltf-pictures: ## glTF models next to Mitsuba 3's pictures of them: build/results/gltf.png
	$(call build,peers,render)
	@$(PYTHON) -B -m host.lab.peers.gltf_pictures

rays: ## rays per second of the cpu engine next to Embree 3
	$(call build,lab,lab scenes)
	@$(LAB) --results $(LAB_ROWS)/rays.jsonl rays scenes/cornell.obj scenes/teapot.obj \
	  scenes/paper.obj $(LARGE_SCENES) build/scenes/landscape.obj

CORE_SCENES := scenes/cornell.obj scenes/teapot.obj build/scenes/sphereflake.obj
ALL_CORE_SCENES := scenes/cornell.obj scenes/paper.obj scenes/teapot.obj $(addprefix build/scenes/, \
  cornell_spheres.obj still_life.obj columns.obj sphereflake.obj)
core: ## the simulated ray core: clocks, lines, bytes a ray by kind, latency, rays in flight, cores: make core [PUBLISH=1]
	$(call build,lab,lab scenes)
	@$(LAB) --results $(LAB_ROWS)/core.jsonl core $(ALL_CORE_SCENES)
	@$(LAB) --results $(LAB_ROWS)/core-wide.jsonl core $(ALL_CORE_SCENES) --latency 200 --in-flight 128
	@$(LAB) --results $(LAB_ROWS)/core-records.jsonl core $(ALL_CORE_SCENES) --records
	@$(LAB) --results $(LAB_ROWS)/core-in-flight.jsonl core $(CORE_SCENES) --kinds camera scattered \
	  --in-flight 1 2 4 8 16 32 64 128 256 --every 4
	@$(LAB) --results $(LAB_ROWS)/core-cores.jsonl core $(CORE_SCENES) --kinds camera scattered \
	  --latency 50 --cores 1 2 4 8 --every 2
	@$(LAB_REPORT) core $(if $(PUBLISH),--publish)

skips: ## tests and time that each skip saves
	$(call build,build,lab scenes)
	@python3 -B scenes/make_teapot.py build/scenes/teapot_coarse.obj --fineness 3
	@$(LAB) --results $(LAB_ROWS)/skips.jsonl skips scenes/paper.obj \
	  build/scenes/teapot_coarse.obj scenes/teapot.obj $(LARGE_SCENES)

techniques: ## what each technique of the path tracer gains: time against error
	$(call build,build,lab scenes)
	@$(LAB) --results $(LAB_ROWS)/techniques.jsonl techniques scenes/cornell.obj scenes/cornell_spheres.json \
	  scenes/paper_room.json scenes/still_life.json scenes/columns.json scenes/teapot.obj \
	  host/lab/peers/scenes/landscape.json scenes/lanterns.json

predicates: ## what an exact decision costs, beside rationals and __float128
	$(call build,build,lab)
	@$(LAB) --results $(LAB_ROWS)/predicates.jsonl predicates

profile: ## what a path-traced picture spends on hit tests, departures, shading and doubts, scene by scene
	$(call build,lab,render scenes)
	@$(LAB_REPORT) profile $(GALLERY) build/scenes/landscape.obj $(if $(RENDER),--render '$(RENDER)')

phase-times: ## load, tree, render, write: milliseconds of a small and two large scenes: make phase-times [BEFORE=PROGRAM]
	$(call build,lab,render scenes)
	@$(LAB_REPORT) phase-times scenes/cornell.obj scenes/teapot.obj build/scenes/sphereflake.obj \
	  build/scenes/landscape.obj $(if $(RENDER),--render '$(RENDER)') $(if $(BEFORE),--before '$(BEFORE)')

adaptive: ## time with --error beside uniform --spp, at equal RMSE and equal FLIP: make adaptive [SCENES='scenes/cornell.obj']
	$(call build,lab,render compare scenes)
	@$(LAB_REPORT) adaptive $(or $(SCENES),$(GALLERY)) $(if $(RENDER),--render '$(RENDER)')

coverage: ## how often the estimated error of --error holds, pixels of known value, 1,000 seeds: make coverage [SEEDS=1000]
	$(call build,test,render_test)
	@RAYGATE_SEEDS=$(or $(SEEDS),1000) build/render_test --gtest_brief=1 --gtest_filter='ErrorEstimate*:*InTheLarge'

scaling: ## time by ranks: measured for 1 and 2, a model up to 1,000: make scaling [PUBLISH=1]
	@$(SETUP) mpi
	@$(SETUP) lab
	@$(configure) -DRAYGATE_MPI=ON >/dev/null
	@cmake --build build -j $(JOBS) --target render scenes
	@$(LAB_REPORT) scaling scenes/cornell.obj build/scenes/landscape.obj $(if $(PUBLISH),--publish)

trace-rates: ## rays per second of ./trace: nearest, any and all hits, tables in and out included
	$(call build,lab,trace scenes)
	@$(LAB_REPORT) trace scenes/cornell.obj scenes/teapot.obj $(LARGE_SCENES) build/scenes/landscape.obj

claims: everything ## check the figures of host/lab/CLAIMS.md by their commands: make claims [ONLY=frame_rates]
	@python3 -B host/lab/claims.py --only '$(ONLY)'
