"""A name on the command line is the design that the report and the layouts have under that name."""

import argparse
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


if __name__ == "__main__":
    unittest.main()
