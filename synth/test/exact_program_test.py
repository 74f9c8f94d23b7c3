"""hw/exact/exact_program_pkg.sv is what the script writes, and waits where it must.

That the micro-programs take the signs of host/exact's polynomials: sim/test/exact, which compares every answer with host/exact.
"""

import copy
import unittest

from synth import exact_program


class ExactProgram(unittest.TestCase):
    """hw/exact/exact_program_pkg.sv."""

    def test_is_what_the_script_writes(self):
        self.assertEqual(exact_program.FILE.read_text(), exact_program.text())

    def test_the_page_says_how_long_requests_take(self):
        self.assertIn(exact_program.table(), (exact_program.FILE.parent / "README.md").read_text())

    def test_fences(self):
        """Every fence is needed: without it a digit is read too early."""
        lengths = exact_program.Lengths(1, 1, 1)
        fences = 0
        for name, program in exact_program.fenced().items():
            for place, one in enumerate(program):
                if one.fence:
                    without = copy.deepcopy(program)
                    without[place].fence = False
                    self.assertEqual(exact_program.unsafe(without, lengths, 1 if name == "Limit" else 3, False), place)
                    fences += 1
        self.assertGreater(fences, 0)
