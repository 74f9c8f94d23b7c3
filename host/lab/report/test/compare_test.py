"""What counts as slower, as noise and as less accurate."""

import copy
import unittest

from host.lab.bench import compare


def row(**changes):
    """A row of a run."""
    return {"table": "pictures", "section": "engines", "scene": "scenes/a.obj", "width": 8, "height": 8,
            "variant": "binary32", "engine": "cpu", "lanes": 1, "threads": 1,
            "integrator": "primary", "samples": 1, "seed": 0,
            "seconds": [9.0, 1.0, 3.0], "processor_seconds": [1.0, 1.01, 0.99],
            "yardstick_seconds": [0.5, 0.5, 0.5], "tests": 100,
            "clocks": 0, "records": 5, "exact_inside": 1, "exact_depth": 0,
            "decisions": {"wrong_hits": 0, "wrong_misses": 0, "wrong_rays": 0},
            "rmse": 0.0, **changes}


def lines(old, new):
    """All but the first line of a comparison of runs of one row."""
    return compare.compare([old], [new])[1:]


class Compare(unittest.TestCase):
    def test_a_run_is_like_itself(self):
        self.assertEqual(lines(row(), row()), [])

    def test_slower_beyond_the_noise(self):
        (line,) = lines(row(), row(processor_seconds=[1.5, 1.51, 1.49]))
        self.assertTrue(line.startswith("slower: engines a 8x8 binary32 cpu: 1 s -> 1.5 s"), line)

    def test_faster(self):
        (line,) = lines(row(), row(processor_seconds=[0.5, 0.51, 0.49]))
        self.assertTrue(line.startswith("faster: "), line)

    def test_within_the_noise(self):
        self.assertEqual(lines(row(), row(processor_seconds=[1.03, 1.04, 1.02])), [])
        wild = row(processor_seconds=[1.0, 1.2, 0.8])  # spread 20 %: five times that says nothing yet
        self.assertEqual(lines(wild, row(processor_seconds=[1.5, 1.51, 1.49])), [])

    def test_a_slower_machine_is_no_slower_program(self):
        slow = row(processor_seconds=[2.0, 2.02, 1.98], yardstick_seconds=[1.0, 1.0, 1.0])
        self.assertEqual(lines(row(), slow), [])

    def test_single_times_are_not_compared(self):
        self.assertEqual(lines(row(seconds=[1.0]), row(seconds=[1.0], processor_seconds=[9.0])), [])

    def test_threads_are_compared_on_the_wall(self):
        old = row(threads=2, seconds=[1.0, 1.0, 1.0])
        (line,) = lines(old, row(threads=2, seconds=[2.0, 2.0, 2.0]))
        self.assertTrue(line.startswith("slower: "), line)

    def test_more_work_and_less_accurate(self):
        worse = row(tests=101, rmse=0.5)
        worse["decisions"] = {**worse["decisions"], "wrong_rays": 2}
        found = lines(row(), worse)
        self.assertEqual([line.partition(":")[0] for line in found],
                         ["more work", "less accurate", "less accurate"])
        self.assertTrue(all(line.startswith("better") for line in lines(worse, row())))

    def test_rows_of_one_run_alone(self):
        other = copy.deepcopy(row(lanes=2))
        head = compare.compare([row(), other], [row()])[0]
        self.assertIn("1 rows compared", head)
        self.assertIn("1 of its rows are not here", head)


if __name__ == "__main__":
    unittest.main()
