"""Report generator: templates, tables, plots."""
