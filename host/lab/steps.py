"""Executes the steps of a target. Completed steps keep their rows, so an interrupted run can be continued."""

import dataclasses
import functools
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable

from host.lab import rows as kept
from host.lab.rows import KEPT, ROOT
from synth import runner, store

LAB = ROOT / "build" / os.environ.get("RAYGATE_LAB", "lab")  # `make variant` builds its own program


@dataclasses.dataclass(frozen=True)
class Step:
    """One measurement: a command of build/lab, or a function that returns rows."""
    part: str
    name: str
    words: tuple = ()
    measure: Callable[[], list[dict]] | None = None

    def command(self, target: str) -> str:
        """Returns the command that reproduces the step's rows."""
        return shlex.join([f"build/{LAB.name}", *map(str, self.words)]) if self.words else f"make {target} ONLY={self.part}"


def run_lab(*words: object) -> list[dict]:
    """Returns the rows that a command of build/lab prints."""
    done = subprocess.run([LAB, *map(str, words)], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    return [json.loads(line) for line in done.stdout.splitlines()]


def run(target: str, steps: list[Step], asked: str = "", at_once: int = 1) -> list[dict]:
    """Returns the rows of all steps. Reuses steps of an interrupted run of the same make command `asked` at the same commit."""
    about = kept.describe()
    stamp = {"commit": about["commit"], "machine": f"{about['processor']}, {about['processors']} processors"}
    folder = KEPT / "unfinished" / target

    def work(step: Step) -> tuple[dict, bool]:
        wanted = store.key([], step.command(target), step.name, asked, stamp)

        def measure() -> dict:
            sys.stderr.write(f"{step.part}: {step.name}\n")
            return {"rows": step.measure() if step.measure else run_lab(*step.words)}

        return store.cached(folder / wanted[:16], wanted, measure)

    results, failures = runner.run_all([runner.Job(step.name, functools.partial(work, step), lambda got: f"{len(got['rows'])} rows")
                                        for step in steps], at_once)
    if failures:
        raise ValueError("\n".join(failures))
    shutil.rmtree(folder, ignore_errors=True)
    return [about, *({"command": step.command(target)} | row | {"part": step.part} | stamp
                     for step, result in zip(steps, results, strict=True) for row in result["rows"])]


def render(command: list, *words: object, picture: pathlib.Path | None = None) -> dict:
    """Returns the statistics of ./render, with the cpu engine unless `words` select another. Does not show warnings."""
    engine = () if "--engine" in words else ("--engine", "cpu")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([*command, *engine, "--quiet", *words, "--output", picture or folder / "picture.exr",
                        "--stats", folder / "stats.json"], cwd=ROOT, stderr=subprocess.PIPE, text=True, check=True)
        return json.loads((folder / "stats.json").read_text())
