"""Executes the steps of a target. Completed steps keep their rows, so an interrupted run can be continued."""

import concurrent.futures
import dataclasses
import hashlib
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable

from host.lab import machine, rows as kept
from host.lab.rows import KEPT, ROOT

LAB = ROOT / "build" / os.environ.get("RAYGATE_LAB", "lab")  # `make variant` has its own program


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


def _measure(step: Step, file: pathlib.Path) -> None:
    if step.measure:
        kept.write(file, step.measure())
        return
    done = subprocess.run([LAB, "--results", f"{file}.unfinished", *map(str, step.words)], cwd=ROOT,
                          stdout=sys.stderr, check=False)
    if done.returncode not in (0, 1):  # 1: the rows report errors
        raise subprocess.CalledProcessError(done.returncode, [LAB, *step.words])
    os.replace(f"{file}.unfinished", file)


def run(target: str, steps: list[Step], asked: str = "", at_once: int = 1) -> list[dict]:
    """Returns the rows of all steps. Reuses steps of an interrupted run of the same make command `asked` at the same
    commit."""
    about = machine.describe(ROOT)
    stamp = {"commit": about["commit"], "machine": f"{about['processor']}, {about['processors']} processors"}
    folder = KEPT / "unfinished" / target
    folder.mkdir(parents=True, exist_ok=True)

    def file_of(step: Step) -> pathlib.Path:
        digest = hashlib.sha256(f"{step.command(target)} {step.name} {asked} {stamp}".encode()).hexdigest()
        return folder / f"{re.sub(r'[^A-Za-z0-9]+', '-', step.name)}-{digest[:10]}.jsonl"

    files = [(step, file_of(step)) for step in steps]
    missing = [(step, file) for step, file in files if not file.exists()]

    def measure(i: int) -> None:
        step, file = missing[i]
        print(f"[{len(files) - len(missing) + i + 1}/{len(files)}] {step.part}: {step.name}", file=sys.stderr)
        _measure(step, file)

    with concurrent.futures.ThreadPoolExecutor(at_once) as pool:
        list(pool.map(measure, range(len(missing))))
    found = [{"command": step.command(target)} | row | {"part": step.part} | stamp
             for step, file in files for row in kept.read(file)]
    shutil.rmtree(folder)
    return [about, *found]


def render(command: list, *words: object, picture: pathlib.Path | None = None, **how: object) -> dict:
    """Returns the statistics of ./render, with the cpu engine unless `words` select another. `how` is passed to
    subprocess.run."""
    engine = () if "--engine" in words else ("--engine", "cpu")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([*command, *engine, "--quiet", *words, "--output", picture or folder / "picture.exr",
                        "--stats", folder / "stats.json"], cwd=ROOT, check=True, **how)
        return json.loads((folder / "stats.json").read_text())
