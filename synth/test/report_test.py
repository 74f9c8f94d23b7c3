"""Tests the tables of the report, and the measurements for these tables."""

import contextlib
import io
import time
import unittest
from unittest import mock

from synth import __main__ as main, catalogue, mapping, measure, prove, report, structure, tables, tools


class Legend(unittest.TestCase):
    def test_explains_the_columns_that_are_there(self) -> None:
        cells = [{"flow": flow, "delay_ns": 1.0} for flow in ("fast", "cells")]
        said = report.legend(cells).splitlines()
        self.assertEqual([line.split(":")[0] for line in said], ["um2 / ns", "ns", "cells", "fast"])
        placed = report.legend([{"flow": "placed", "mhz": 98.0}]).splitlines()
        self.assertEqual([line.split(":")[0] for line in placed], ["LUTs / MHz"])


class Others(unittest.TestCase):
    def test_an_adder_has_rows_to_compare_with_on_every_target(self) -> None:
        measured = []
        with (mock.patch.object(measure, "measure", side_effect=lambda rows, *_, **__: measured.append(rows) or []),
              mock.patch.object(prove, "adds"), mock.patch.object(structure, "netlist"), mock.patch.object(structure, "hardware", return_value={"gate": 1}),
              contextlib.redirect_stdout(io.StringIO())):
            main.run_one(catalogue.design("adder", adder="graded", widths=[4, 5], Width=9), measure.Targets(("osu035", "ice40")))
        self.assertEqual([[sorted(row.flows) for row in rows] for rows in measured], [[["ice40", "osu035"]] * 6] * 2)


class Measured(unittest.TestCase):
    """Tests measured_tables."""

    def test_a_row_is_printed_when_it_is_measured(self) -> None:
        rows = [catalogue.Row("adders", catalogue.Design(name, "adder", "arith"), {"osu035": ("cells", "fast"), "ice40": ("placed",)})
                for name in ("ripple", "prefix")]
        printed, waited = io.StringIO(), []

        def measured(design: catalogue.Design, library: catalogue.Library, flow: str) -> tuple[dict, bool]:
            limit = time.monotonic() + 10
            while design.name == "prefix" and "| ripple " not in printed.getvalue() and time.monotonic() < limit:
                time.sleep(0.01)  # the first row is printed before the second is measured
            waited.append(time.monotonic() < limit)
            if (design.name, flow) == ("prefix", "fast"):
                raise tools.ToolFailed("no")
            return {"area": 1000, "delay_ns": 2.5}, False

        with (mock.patch.object(mapping, "synthesise", side_effect=measured), contextlib.redirect_stdout(printed),
              mock.patch.object(catalogue.Library, "structural", True), contextlib.redirect_stderr(io.StringIO())):
            records, failures, text = report.measured_tables(rows, measure.Targets(("osu035",), 1))
        self.assertEqual((len(records), failures, set(waited)), (3, ["prefix osu035 fast: no"], {True}))
        cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in printed.getvalue().splitlines()]
        self.assertEqual(text + "\n", printed.getvalue())
        self.assertEqual(cells, [["adders, OSU 0.35 um: um2 / ns", "cells", "fast"], cells[1], ["ripple", "1,000 / 2.50", "1,000 / 2.50"],
                                 ["prefix", "1,000 / 2.50", "-"], []])


class Targets(unittest.TestCase):
    """Tests measure.available and catalogue.first_rows."""

    def test_the_main_designs_are_designs_of_the_report(self) -> None:
        rows = catalogue.first_rows()
        self.assertEqual({row.design.name for row in rows}, catalogue.FIRST)
        self.assertTrue(all(row.flows["osu035"] for row in rows))

    def test_what_is_measured_unless_targets_are_given(self) -> None:
        with mock.patch.object(tools, "find"), mock.patch.object(tools, "installed", return_value=True):
            self.assertEqual(measure.available(None, everything=False), ("osu035",))
            self.assertEqual(measure.available(None, everything=False, one=True), ("osu035", "osu018"))
            self.assertEqual(measure.available(None), ("osu035", "osu018", "ice40", "ecp5"))
            self.assertEqual(measure.available(["ecp5", "osu018"], everything=False), ("osu018", "ecp5"))
            with self.assertRaisesRegex(ValueError, "no target x; there are osu035, "):
                measure.available(["x", "ecp5"])


class Tables(unittest.TestCase):
    """Tests the two forms of tables."""

    def test_markdown(self):
        """Columns are aligned; numbers are right-aligned."""
        self.assertEqual(tables.markdown(["what", "ns"], [["a", "9.5"], ["b", "10.5"]]),
                         "| what |   ns |\n|------|-----:|\n| a    |  9.5 |\n| b    | 10.5 |\n")

    def test_comma_separated(self):
        """Missing values are empty. Columns that are not requested are left out."""
        self.assertEqual(tables.comma_separated([{"a": 1, "c": 2}], ["a", "b"]), "a,b\n1,\n")
