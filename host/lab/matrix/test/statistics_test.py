"""Medians, spreads, power laws and fronts, on figures worked out by hand."""

import unittest

from host.lab.matrix import statistics


class Statistics(unittest.TestCase):
    def test_median_and_spread(self):
        self.assertEqual(statistics.median([3, 1, 2]), 2)
        self.assertEqual(statistics.median([4, 1, 2, 3]), 2.5)
        # Distances from 10: 0, 1, 1, 2, 90. One wild value doesn't count.
        self.assertEqual(statistics.spread([10, 9, 11, 12, 100]), 1 / 11)
        self.assertEqual(statistics.spread([5.0]), 0)

    def test_power_law_of_exact_points(self):
        law = statistics.power_law([1, 2, 4, 8], [3, 12, 48, 192])
        self.assertAlmostEqual(law.exponent, 2)
        self.assertAlmostEqual(law.factor, 3)
        self.assertAlmostEqual(law.exponent_error, 0)
        self.assertAlmostEqual(law.largest_miss, 1)
        self.assertAlmostEqual(law.at(10), 300)

    def test_power_law_says_how_bad_it_is(self):
        law = statistics.power_law([1, 10, 100], [1, 20, 100])
        self.assertAlmostEqual(law.exponent, 1)
        self.assertGreater(law.exponent_error, 0.1)
        self.assertAlmostEqual(law.largest_miss, 4 ** (1 / 3))  # misses: -1/3, 2/3, -1/3 of log 2

    def test_no_power_law_through_one_point(self):
        self.assertIsNone(statistics.power_law([2, 2], [1, 3]))
        self.assertIsNone(statistics.power_law([], []))

    def test_front(self):
        # 1 is worse than 0 in both; 3 equals 0 in x and is worse; 4 is best in y.
        points = [(1, 5), (2, 6), (3, 2), (1, 7), (9, 1)]
        self.assertEqual(statistics.front(points), [0, 2, 4])


if __name__ == "__main__":
    unittest.main()
