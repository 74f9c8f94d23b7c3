"""Describes the machine, the tools and the sources of a measurement."""

import datetime
import os
import pathlib
import platform
import re
import subprocess


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


def describe(root: pathlib.Path) -> dict:
    """Returns the machine, the tools and the sources as a row. Unknown values are empty."""
    info = pathlib.Path("/proc/cpuinfo")
    cpu = info.read_text() if info.exists() else ""
    cache = root / "build" / "CMakeCache.txt"
    settings = cache.read_text() if cache.exists() else ""
    compiler = _first(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", settings)
    return {
        "table": "machine",
        "processor": _first(r"^model name\s*:\s*(.*)$", cpu) or platform.processor(),
        "processors": processors(),
        "compiler": _first(r"^(.*)$", _output(compiler, "--version")) if compiler else "",
        "date": datetime.date.today().isoformat(),
        "commit": _output("git", "-C", str(root), "rev-parse", "--short=12", "HEAD"),
        "changed_files": len(_output("git", "-C", str(root), "status", "--porcelain",
                                     "--untracked-files=no").splitlines()),
    }
