"""Where a line of measured errors has the error of another picture."""

import unittest

from host.lab.peers import adaptive


class Interpolated(unittest.TestCase):
    def test_between_measured_errors(self) -> None:
        self.assertAlmostEqual(adaptive.interpolated([0.4, 0.2, 0.1], [1.0, 4.0, 16.0], 0.2), 4.0)
        self.assertAlmostEqual(adaptive.interpolated([0.4, 0.2, 0.1], [1.0, 4.0, 16.0], 0.2 / 2 ** 0.5), 8.0)
        self.assertAlmostEqual(adaptive.interpolated([0.4, 0.2], [1.0, 3.0], 0.3), 3 ** (1 - 0.5849625007))

    def test_beyond_them_by_the_law_of_large_numbers(self) -> None:
        self.assertAlmostEqual(adaptive.interpolated([0.4, 0.2], [1.0, 3.0], 0.1), 12.0)
        self.assertAlmostEqual(adaptive.interpolated([0.4, 0.2], [1.0, 3.0], 0.8), 0.25)


if __name__ == "__main__":
    unittest.main()
