"""Completed steps are not repeated; rows name the command, commit and machine that produced them."""

import pathlib
import tempfile
import unittest
from unittest import mock

from host.lab import rows, steps


class Steps(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.kept = pathlib.Path(folder.name)
        self.measured: list[str] = []
        self.fails = ""

    def run_steps(self, asked: str = "") -> list[dict]:
        """Runs two steps, one of which may fail, and returns their rows."""
        def step(name: str) -> steps.Step:
            def measure() -> list[dict]:
                if name == self.fails:
                    raise ValueError(name)
                self.measured.append(name)
                return [{"table": "t", "name": name}]
            return steps.Step("part", name, measure=measure)

        with mock.patch.object(steps, "KEPT", self.kept):
            return steps.run("speed", [step("a"), step("b, c")], asked)

    def test_rows_have_command_commit_and_machine(self) -> None:
        about, *found = self.run_steps()
        self.assertEqual([row["name"] for row in found], ["a", "b, c"])
        self.assertEqual([about["table"], about["commit"]], ["machine", found[0]["commit"]])
        self.assertEqual({key: found[0][key] for key in ("part", "command")}, {"part": "part", "command": "make speed ONLY=part"})
        self.assertIn(about["processor"], found[0]["machine"])

    def test_an_interrupted_run_goes_on(self) -> None:
        self.fails = "b, c"
        with self.assertRaises(ValueError):
            self.run_steps()
        self.fails = ""
        self.assertEqual(len(self.run_steps()), 3)
        self.assertEqual(self.measured, ["a", "b, c"])
        self.run_steps()  # after a complete run: measures again
        self.assertEqual(self.measured, ["a", "b, c"] * 2)

    def test_another_run_does_not(self) -> None:
        self.fails = "b, c"
        with self.assertRaises(ValueError):
            self.run_steps("QUICK=1")
        self.fails = ""
        self.run_steps()
        self.assertEqual(self.measured, ["a", "a", "b, c"])

    def test_a_file_is_whole_or_not_there(self) -> None:
        with self.assertRaises(TypeError):
            rows.write(self.kept / "rows.jsonl", [{"a": 1}, {"a": object()}])
        self.assertFalse((self.kept / "rows.jsonl").exists())
        rows.write(self.kept / "rows.jsonl", [{"a": 1}])
        self.assertEqual(rows.read(self.kept / "rows.jsonl"), [{"a": 1}])
