"""Tests of synth.store."""

import concurrent.futures
import pathlib
import tempfile
import time
import unittest

from synth import store


class Cached(unittest.TestCase):
    """store.cached."""

    def test_jobs_that_want_the_same_wait_for_one(self):
        made = []

        def make() -> dict:
            made.append(time.monotonic())
            time.sleep(0.05)
            return {"area": 7}

        with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(4) as pool:
            results = list(pool.map(lambda _: store.cached(pathlib.Path(folder) / "run", "key", make), range(4)))
        self.assertEqual(len(made), 1)
        self.assertEqual(sorted(kept for _, kept in results), [False, True, True, True])
        self.assertTrue(all(result == {"area": 7} for result, _ in results))

    def test_another_key_makes_it_anew(self):
        with tempfile.TemporaryDirectory() as folder:
            run = pathlib.Path(folder)
            self.assertEqual(store.cached(run, "old", lambda: {"n": 1}), ({"n": 1}, False))
            self.assertEqual(store.cached(run, "new", lambda: {"n": 2}), ({"n": 2}, False))
            self.assertEqual(store.cached(run, "new", lambda: {"n": 3}), ({"n": 2}, True))


if __name__ == "__main__":
    unittest.main()
