"""Runs Yosys (Python package pyosys) in a separate process, so that a crash of Yosys does not end the caller.

`python3 -m synth.yosys 'COMMANDS'` runs commands, one per line or separated by semicolons, and prints Yosys's log. With --strict, warnings
are errors. `python3 -m synth.yosys --abc 'COMMANDS'` runs ABC. The exit status is 1 if a command fails.
"""

import argparse
import importlib.metadata
import importlib.util
import os
import pathlib
import sys
from collections.abc import Iterable

from synth import tools


def folder() -> pathlib.Path:
    """Returns the folder of package pyosys, in this Python or in the environment made by .ci/setup. The folder has yosys-abc and,
    in share/, cell models and techmap files. Raises MissingTool."""
    spec = importlib.util.find_spec("pyosys")
    found = [pathlib.Path(spec.origin).parent] if spec else [*tools.VENV.glob("lib/*/site-packages/pyosys")]
    if not found:
        raise tools.MissingTool("Yosys is not installed: pip install -r synth/requirements.txt")
    return found[0]


def _python() -> str:
    """Returns the path of the Python interpreter that has package pyosys. Raises MissingTool if none has it."""
    return str(tools.VENV / "bin" / "python3") if tools.VENV in folder().parents else sys.executable


def installed() -> bool:
    """Returns whether `run` would find Yosys."""
    try:
        return folder().exists()
    except tools.MissingTool:
        return False


def version() -> str:
    """Returns the version of Yosys, e.g. "0.70", or "" if Yosys is not installed."""
    if not installed():
        return ""
    (found,) = importlib.metadata.distributions(name="pyosys", path=[str(folder().parent)])
    return found.version


def read(sources: Iterable[pathlib.Path], top: str, parameters: Iterable[tuple[str, object]] = (), options: str = "") -> str:
    """Returns the commands that elaborate `top`. The hierarchy is kept. Instances with equal parameters share one module, which is named
    MODULE$PATH after the first instance."""
    overrides = "".join(f"-G {name}={value} " for name, value in parameters)
    return (f"read_slang -j 1 --keep-hierarchy --disable-instance-caching=false {options} {overrides}--top {top} "
            f"{' '.join(map(str, sources))}\nhierarchy -check -top {top}")


def run(script: str, log: pathlib.Path) -> str:
    """Runs a script and returns Yosys's log. Keeps the script beside `log`, with suffix .ys. Raises ToolFailed and MissingTool."""
    file = log.with_suffix(".ys")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(script + "\n")
    return tools.run([_python(), "-m", "synth.yosys", "--file", file], log, name="yosys")


def abc(commands: str, log: pathlib.Path) -> str:
    """Runs ABC; returns what it prints. Raises ToolFailed and MissingTool."""
    return tools.run([folder() / "yosys-abc", "-c", commands], log)


def main() -> int:
    """Runs the command line."""
    parser = argparse.ArgumentParser(prog="synth.yosys", description="Runs commands of Yosys, or of ABC.")
    parser.add_argument("commands", nargs="?", help="one a line, or separated by semicolons")
    parser.add_argument("--file", help="a file of commands in their place")
    parser.add_argument("--strict", action="store_true", help="fail at a warning, too")
    parser.add_argument("--abc", action="store_true", help="commands of ABC")
    given = parser.parse_args()
    try:
        if given.abc:
            os.execv(folder() / "yosys-abc", ["yosys-abc", "-c", given.commands])
        if not importlib.util.find_spec("pyosys"):  # the system's Python, from CMake or a shell
            os.execv(_python(), [_python(), "-m", "synth.yosys", *sys.argv[1:]])
    except tools.MissingTool as error:
        print(f"synth.yosys: {error}", file=sys.stderr)
        return 2
    from pyosys import libyosys  # imported only here: the import takes a tenth of a second, and Yosys may end the process

    if given.strict:
        libyosys.run_pass("logger -werror .")
    libyosys.run_pass(f"script {given.file}" if given.file else given.commands)
    return 0


if __name__ == "__main__":
    sys.exit(main())
