"""Tests guards.toml and the plans of guards.py. Runs in the root of the checkout, after the build."""

import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / ".ci"))

import guards  # noqa: E402


class Table(unittest.TestCase):
    def test_every_file_is_guarded(self):
        for file in guards.git("ls-files").splitlines():
            self.assertTrue(any(guards.is_touched(guard, [file]) for guard in guards.TABLE.values()), file)

    def test_every_room_with_tests_is_under_a_sanitizer_or_says_why_not(self):
        guard = guards.TABLE["address-sanitizer"]
        rooms = {file.split("/")[1] for file in guards.git("ls-files", "host/*/test/*_test.cpp").splitlines()}
        self.assertEqual(rooms - set(guard["rooms"]) - set(guard["without"]), set())

    def test_names_are_there(self):
        """All path prefixes, tests and texts to be replaced by faults exist."""
        files, tests = guards.git("ls-files").splitlines(), guards.tests_of("build")
        for name, guard in guards.TABLE.items():
            with self.subTest(name):
                for path in guard["files"]:
                    self.assertTrue(guards.is_touched({"files": [path]}, files), path)
                self.assertNotEqual("tests" in guard, "run" in guard)
                if "tests" in guard:
                    self.assertTrue([test for test in tests if re.search(guard["tests"], test)])
                fault = guard["fault"]
                self.assertIn(fault["find"], (ROOT / fault["file"]).read_text())
                self.assertTrue(guards.is_touched(guard, [fault["file"]]))


class Plan(unittest.TestCase):
    CASES = [f"case {number}" for number in range(40)]

    def test_a_touched_guard_runs_in_full(self):
        for run in range(3):
            self.assertEqual(guards.Plan(["hw/fp/fp_adder.sv"], run).cases("mutation", self.CASES), self.CASES)

    def test_an_untouched_guard_runs_within_its_turns(self):
        runs = [guards.Plan(["README.md"], run).cases("mutation", self.CASES) for run in range(5, 8)]
        self.assertEqual(sorted(sum(runs, [])), sorted(self.CASES))
        self.assertTrue(all(0 < len(cases) < len(self.CASES) for cases in runs))
        self.assertEqual(guards.Plan(["README.md"], 5).cases("verilator", self.CASES), self.CASES)

    def test_a_change_of_the_set_up_runs_everything(self):
        for file in (".ci/setup", ".clang-tidy", "host/CMakeLists.txt"):
            for name in ("mutation", "clang-tidy", "address-sanitizer"):
                self.assertEqual(guards.Plan([file], 1).cases(name, self.CASES), self.CASES)

    def test_sources_of_a_touched_room_all_run(self):
        places = ("host/light", "host/CMakeFiles/raygate_light.dir/Unity", "host/scene", "host/CMakeFiles/raygate_scene.dir/Unity")
        sources = [f"{place}/{name}.cpp" for place in places for name in "abcd"]
        runs = [guards.Plan(["host/light/lights.h"], run).cases("clang-tidy", sources) for run in range(3)]
        for cases in runs:
            self.assertTrue(set(sources[:8]) <= set(cases))
        self.assertEqual(set().union(*runs), set(sources))

    def test_rooms_above_a_touched_one_run(self):
        rooms = guards.TABLE["address-sanitizer"]["rooms"]
        self.assertEqual(guards.Plan(["host/base/elementary.h"], 0).cases("address-sanitizer", rooms), rooms)
        runs = [guards.Plan(["host/film/film.h"], run).cases("address-sanitizer", rooms) for run in range(3)]
        for cases in runs:
            self.assertTrue(set(rooms[rooms.index("film"):]) <= set(cases))
        self.assertEqual(set().union(*runs), set(rooms))

    def test_tests_without_a_turn_are_skipped(self):
        tests = ["uart_test.random_reset_1", "uart_test.random_reset_2", "uart_test.random_reset_3", "film.Film.IsEmpty"]
        skipped = [guards.Plan(["README.md"], run).skipped(tests) for run in range(3)]
        for names in skipped:
            self.assertTrue(set(names) <= set(tests[1:3]))
        self.assertEqual(set.intersection(*map(set, skipped)), set())
        self.assertEqual(guards.Plan(["sim/model.h"], 0).skipped(tests), [])


if __name__ == "__main__":
    unittest.main()
