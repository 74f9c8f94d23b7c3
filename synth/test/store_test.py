"""Tests of synth.store."""

import concurrent.futures
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock

from synth import store, tools


class Cached(unittest.TestCase):
    """Tests store.cached."""

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

    def test_a_file_that_many_write_is_always_whole(self):
        with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(8) as pool:
            file = pathlib.Path(folder) / "tiny.lib"

            def write(number: int) -> str:
                store.replace(file, str(number % 2) * 30000)
                return file.read_text()

            self.assertEqual(set(pool.map(write, range(40))), {"0" * 30000, "1" * 30000})
            self.assertEqual(list(file.parent.iterdir()), [file])

    def test_ctrl_c_prints_one_line(self):
        done = subprocess.run([sys.executable, "-c", "import synth\nraise KeyboardInterrupt"], cwd=tools.ROOT, capture_output=True,
                              text=True, check=False)
        self.assertEqual(done.returncode, -signal.SIGINT)  # a shell says 130
        self.assertEqual(done.stderr, "interrupted; what was finished is kept\n")

    def test_another_key_makes_it_anew(self):
        with tempfile.TemporaryDirectory() as folder:
            run = pathlib.Path(folder)
            self.assertEqual(store.cached(run, "old", lambda: {"n": 1}), ({"n": 1}, False))
            self.assertEqual(store.cached(run, "new", lambda: {"n": 2}), ({"n": 2}, False))
            self.assertEqual(store.cached(run, "new", lambda: {"n": 3}), ({"n": 2}, True))

    def test_a_proof_is_proven_or_refuted_once_for_all_folders(self):
        runs = []

        def prove() -> dict:
            runs.append("proven")
            return {"holds": True}

        def refute() -> dict:
            runs.append("refuted")
            raise tools.Refuted("a < b", {"a": "1", "b": "0"})

        def give_up() -> dict:
            runs.append("gave up")
            raise tools.ToolFailed("out of time")

        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder)
            with unittest.mock.patch.object(store, "PROVEN", place / "proven"):
                for number, checkout in enumerate(("one", "other")):
                    result, kept = store.proven(place / checkout, "k1", prove)
                    self.assertTrue(result["holds"])
                    self.assertEqual(kept, number > 0)
                    with self.assertRaisesRegex(tools.Refuted, "a < b does not hold") as refused:
                        store.proven(place / checkout, "k2", refute)
                    self.assertEqual(refused.exception.values, {"a": "1", "b": "0"})
                    with self.assertRaisesRegex(tools.ToolFailed, "out of time"):
                        store.proven(place / checkout, "k3", give_up)
        self.assertEqual(runs, ["proven", "refuted", "gave up", "gave up"])
