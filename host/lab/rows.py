"""Rows of the lab: JSON objects, one per line, each with the command, commit and machine that produced it."""

import datetime
import json
import os
import pathlib
import platform
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
KEPT = ROOT / "build" / "results"


def read(file: pathlib.Path) -> list[dict]:
    """Returns all rows of a file."""
    return [json.loads(line) for line in file.read_text().splitlines()]


def write(file: pathlib.Path, rows: list[dict]) -> None:
    """Atomically replaces the file."""
    file.parent.mkdir(parents=True, exist_ok=True)
    unfinished = file.with_suffix(".unfinished")
    unfinished.write_text("".join(json.dumps(row) + "\n" for row in rows))
    os.replace(unfinished, file)


def of(rows: list[dict], table: str, **values: object) -> list[dict]:
    """Returns the rows of a table whose columns have these values."""
    return [row for row in rows if row["table"] == table and all(row.get(name) == value for name, value in values.items())]


def scene_name(row: dict) -> str:
    """Returns the scene's name, such as `cornell` for scenes/cornell.obj."""
    return pathlib.Path(row["scene"]).stem


def grouped(rows: list[dict], by: tuple[str, ...], over: str) -> list[dict]:
    """Returns one row for each combination of values of the columns `by`. Its `at` maps the values of column `over` to rows."""
    found: dict[tuple, dict] = {}
    for row in rows:
        found.setdefault(tuple(row[key] for key in by), {**row, "at": {}})["at"][row[over]] = row
    return list(found.values())


def _first(pattern: str, text: str) -> str:
    found = re.search(pattern, text, re.MULTILINE)
    return found.group(1).strip() if found else ""


def _output(*command: str) -> str:
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return ""
    return (done.stdout + done.stderr).strip()


def processors() -> int:
    """Returns the number of processors that this process may use."""
    return len(os.sched_getaffinity(0))


def describe() -> dict:
    """Returns the machine, the tools and the sources as a row. Unknown values are empty."""
    info = pathlib.Path("/proc/cpuinfo")
    cpu = info.read_text() if info.exists() else ""
    cache = ROOT / "build" / "CMakeCache.txt"
    settings = cache.read_text() if cache.exists() else ""
    compiler = _first(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", settings)
    return {
        "table": "machine",
        "processor": ", ".join(text for text in (_first(r"^model name\s*:\s*(.*)$", cpu) or platform.processor(),
                                                 *(f"{name} {value}" for name, value in re.findall(r"^(cpu family|model)\s*: (\d+)$", cpu, re.M)[:2]))
                               if text),
        "processors": processors(),
        "compiler": _first(r"^(.*)$", _output(compiler, "--version")) if compiler else "",
        "date": datetime.date.today().isoformat(),
        "commit": _output("git", "-C", str(ROOT), "rev-parse", "--short=12", "HEAD"),
        "changed_files": len(_output("git", "-C", str(ROOT), "status", "--porcelain",
                                     "--untracked-files=no").splitlines()),
    }
