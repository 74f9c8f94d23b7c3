# `make bench`: see host/lab/README.md.
.PHONY: bench

bench: ## run time against error, one report: make bench [QUICK=1 BASE=old.json]
	$(call build,bench,picture_bench unit_bench compare table_1 worked_example scenes)
	@$(PYTHON) -m host.lab.matrix $(if $(QUICK),--quick) $(if $(BASE),--base '$(BASE)') \
	  $(if $(PUBLISH),--publish)
