"""The search of group widths, against exhaustive search and the paper."""

import itertools
import unittest

from synth import catalogue, grading
from synth.unit_delay import COUNTINGS, Counting


def delay(groups: tuple[int, ...], counting: Counting) -> float:
    """The last sum bit of a carry-select adder, straight from its definition."""
    carry, slowest = None, 0.0
    for size in groups:
        ready = 0.0
        for _ in range(size):
            ready += 1
            at = ready if carry is None else max(ready, carry) + counting.last_multiplexer
            slowest = max(slowest, at)
        carry = ready if carry is None else max(ready, carry) + counting.multiplexer
    return slowest


def compositions(total: int) -> list[tuple[int, ...]]:
    """All ways to cut `total` bits into groups."""
    found = []
    for cuts in itertools.product((0, 1), repeat=total - 1):
        groups, size = [], 1
        for cut in cuts:
            if cut:
                groups.append(size)
                size = 0
            size += 1
        found.append((*groups, size))
    return found


class Grading(unittest.TestCase):
    """best_by_model."""

    def test_optimum_of_10_bits(self):
        """The dynamic programme finds what trying all 512 groupings finds."""
        for counting in COUNTINGS:
            found, groups = grading.best_by_model(10, counting)
            self.assertEqual(found, min(delay(g, counting) for g in compositions(10)))
            self.assertEqual(found, delay(groups, counting))

    def test_paper(self):
        """10 delays for 48 bits where the multiplexer of the sum bit isn't counted, else 11."""
        self.assertEqual(grading.best_by_model(48, COUNTINGS[1])[0], 10)
        self.assertEqual(grading.best_by_model(48, COUNTINGS[0])[0], 11)

    def test_group_vector(self):
        """The lowest group is the lowest byte."""
        self.assertEqual(catalogue.group_widths([4, 5]), "128'h" + "0" * 28 + "0504")
        with self.assertRaises(ValueError):
            catalogue.group_widths([3] * 17)


if __name__ == "__main__":
    unittest.main()
