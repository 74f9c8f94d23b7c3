# `make rays`: see host/lab/rays/README.md.
.PHONY: rays

rays: ## rays a second of the cpu engine next to Embree 3: one table
	$(call build,bench,ray_bench scenes)
	@build/ray_bench scenes/cornell.obj scenes/teapot.obj scenes/paper.obj \
	  build/scenes/sphere.obj build/scenes/sphereflake.obj build/scenes/landscape.obj
