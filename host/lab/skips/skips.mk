# What each skip saves, on the paper's scene and larger ones.
.PHONY: skips
skips: ## tests and time that each skip saves: a table of one run
	$(call build,build,skip_bench scenes)
	@python3 -B scenes/make_teapot.py build/scenes/teapot_coarse.obj --fineness 3
	@build/skip_bench scenes/paper.obj build/scenes/teapot_coarse.obj scenes/teapot.obj \
	  build/scenes/sphere.obj build/scenes/sphereflake.obj
