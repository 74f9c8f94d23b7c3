"""The report generator: templates, tables, plots."""
