# `make rays`: see host/lab/rays/README.md.
.PHONY: rays

rays: ## rays a second of the cpu engine next to Embree 3: one table
	@$(SETUP) bench
	@test -f build/build.ninja || cmake -S . -B build -G Ninja -DBUILD_TESTING=OFF
	@cmake --build build -j $(JOBS) --target ray_bench scenes
	@build/ray_bench scenes/cornell.obj scenes/teapot.obj scenes/paper.obj \
	  build/scenes/sphere.obj build/scenes/sphereflake.obj build/scenes/landscape.obj
