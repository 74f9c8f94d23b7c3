"""Tables of the report."""

import contextlib
import io
import unittest
from unittest import mock

from synth import __main__ as main
from synth import catalogue, measure, prove, report


class ClockTable(unittest.TestCase):
    """Of cells and of an FPGA."""

    def test_has_what_is_timed_in_ns_alone(self) -> None:
        cells = {"design": "hit_test_unit", "target": "osu035", "flow": "parts", "delay_ns": 50.0, "from": "N", "to": "output_q"}
        placed = {"design": "adder", "target": "ecp5", "flow": "placed", "mhz": 98.0, "from": "a", "to": "sum"}
        lines = report.clock_table([cells, placed]).splitlines()
        self.assertEqual(len(lines), 3)
        self.assertIn("20.0", lines[2])


class Legend(unittest.TestCase):
    def test_explains_the_columns_that_are_there(self) -> None:
        cells = [{"flow": flow, "delay_ns": 1.0} for flow in ("fast", "cells")]
        said = report.legend(cells).splitlines()
        self.assertEqual([line.split(":")[0] for line in said], ["um2 / ns", "cells", "fast"])
        placed = report.legend([{"flow": "placed", "mhz": 98.0}]).splitlines()
        self.assertEqual([line.split(":")[0] for line in placed], ["LUTs / MHz"])


class Others(unittest.TestCase):
    def test_an_adder_has_rows_to_compare_with_on_every_target(self) -> None:
        measured = []
        with (mock.patch.object(measure, "measure", side_effect=lambda rows, _: measured.extend(rows) or ([], [])),
              mock.patch.object(prove, "adds"), mock.patch.object(main, "kept_structure", return_value=False),
              contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()) as said):
            main.run_one(catalogue.design("adder", adder="graded", widths=[4, 5], Width=9), measure.Targets(("osu035", "ice40")))
        self.assertEqual([sorted(row.flows) for row in measured], [["ice40", "osu035"]] * 5)
        self.assertRegex(said.getvalue(), "^adder-graded-4_5-Width9, beside 4 other adders: 25 netlists on osu035, ice40; about a minute")


if __name__ == "__main__":
    unittest.main()
