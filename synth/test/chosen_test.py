"""A name on the command line is the design that the report and the layouts have under that name."""

import argparse
import contextlib
import io
import sys
import unittest
from unittest import mock

from synth import catalogue, chosen


def design(*words: str) -> catalogue.Design:
    """What `make synth TOP=... ...` describes."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--top")
    chosen.add_arguments(parser)
    with mock.patch.object(sys, "argv", ["synth", *words]):
        return chosen.design(chosen.parse(parser))


class Chosen(unittest.TestCase):
    def test_names_are_those_of_the_report(self) -> None:
        reported = {row.design.name: row.design for row in catalogue.report_rows()}
        for kind in ("ripple", "graded", "prefix"):
            with self.subTest(kind):
                given = design("--top=adder", f"--adder={kind}", "--width=48")
                self.assertEqual(dict(given.parameters), dict(reported[f"adder-{kind}"].parameters))
        ahead = design("--top=adder", "--adder=graded", "--width=48", "--look-ahead=1")
        self.assertEqual(dict(ahead.parameters), dict(reported["adder-graded-look-ahead"].parameters))
        self.assertIn("look_ahead", ahead.name)

    def test_groups_of_a_multiplier_are_as_in_the_rtl(self) -> None:
        self.assertNotIn("LookAhead", dict(design("--top=booth_multiplier", "--adder=graded").parameters))

    def test_parameters_that_a_module_cannot_have(self) -> None:
        for words, said in (("--top=fp_adder --groups=4,5", "fp_adder: found parameter GroupWidths, expected one of ExpWidth, FracWidth, Arith"),
                            ("--top=fp_adder --exp-width=4", r"fp_adder: found ExpWidth=4 and FracWidth=23, expected 2 <= FracWidth <= 2\^"),
                            ("--top=booth_multiplier --width=1", "booth_multiplier: found Width=1, expected at least 2 and at most 4080")):
            with self.subTest(words), self.assertRaisesRegex(ValueError, said):
                design(*words.split())
        for name, value, said in (("Width", "0", "expected at least 1"), ("Width", "-3", "expected a whole number"), ("Width", "", "expected a whole"),
                                  ("Depth", "2", "found parameter Depth, expected one of Width, Arith, GroupWidths, LookAhead")):
            with self.subTest(name, value=value), self.assertRaisesRegex(ValueError, f"^adder: .*{said}"):
                catalogue.design("adder", **{name: value})

    def test_a_wrong_value_is_told_in_one_line(self) -> None:
        said = io.StringIO()
        with contextlib.redirect_stderr(said), self.assertRaises(SystemExit) as ended:
            design("--top=fp_adder", "--frac-width=1")
        self.assertEqual((ended.exception.code, said.getvalue().count("\n")), (2, 1))
        self.assertRegex(said.getvalue(), "--frac-width: expected a whole number from 2 to 112, got '1'")


if __name__ == "__main__":
    unittest.main()
