"""The search of group widths, against exhaustive search and the paper."""

import itertools
import unittest

from synth import catalogue, grading
from synth.unit_delay import COUNTINGS, Counting


def delay(groups: tuple[int, ...], counting: Counting, arrivals: list[float]) -> float:
    """The last sum bit of a carry-select adder, straight from its definition."""
    position, carry, slowest = 0, None, 0.0
    for size in groups:
        ready = 0.0
        for bit in range(position, position + size):
            ready = max(ready, arrivals[bit]) + 1
            at = ready if carry is None else max(ready, carry) + counting.last_multiplexer
            slowest = max(slowest, at)
        carry = ready if carry is None else max(ready, carry) + counting.multiplexer
        position += size
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
    """best_by_model and the helpers of the measured search."""

    def test_optimum_of_10_bits(self):
        """The dynamic programme finds what trying all 512 groupings finds."""
        late_middle = [0.0, 0, 1, 2, 3, 3, 3, 2, 1, 0]
        for counting in COUNTINGS:
            for arrivals in ([0.0] * 10, late_middle):
                found, groups = grading.best_by_model(10, counting, arrivals)
                self.assertEqual(found, min(delay(g, counting, arrivals) for g in compositions(10)))
                self.assertEqual(found, delay(groups, counting, arrivals))

    def test_paper(self):
        """10 delays for 48 bits where the multiplexer of the sum bit isn't counted, else 11."""
        self.assertEqual(grading.best_by_model(48, COUNTINGS[1])[0], 10)
        self.assertEqual(grading.best_by_model(48, COUNTINGS[0])[0], 11)

    def test_neighbours(self):
        """Neighbours have as many bits, no empty group, and not the grouping itself."""
        near = grading.neighbours((3, 1, 4))
        self.assertIn((3, 5), near)
        self.assertIn((2, 2, 4), near)
        self.assertNotIn((3, 1, 4), near)
        self.assertTrue(all(sum(groups) == 8 and min(groups) > 0 for groups in near))

    def test_group_vector(self):
        """The lowest group is the lowest byte."""
        self.assertEqual(catalogue.group_widths([4, 5]), "128'h" + "0" * 28 + "0504")
        with self.assertRaises(ValueError):
            catalogue.group_widths([3] * 17)


if __name__ == "__main__":
    unittest.main()
