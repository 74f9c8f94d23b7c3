"""Runs the commands of README.md and the tutorials as written, in order.

`python3 host/test/commands.py`: runs all commands, from installation to proofs, in a clone of this commit,
build/commands. Takes hours. With --quick: runs only those of this build's programs and of the Python module, with small
pictures. Their output is kept in build/commands-PAGE.log. Exit status 1 if a command fails.
"""

import argparse
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = ["host/docs/hardware.md", "host/docs/pictures.md", "host/docs/python.md", "README.md"]  # README.md needs python.md
QUICK = ("./render", "timeout", "./trace", "./merge", "echo", "mkdir", "cat", '"$PYTHON"')
PROGRAMS = ("render", "trace", "merge")
SERVED = 20  # seconds until a page of --serve is closed, as by Ctrl-C


def commands(text: str) -> list[str]:
    """Returns the commands of a page: each line of `sh` blocks; for each `json` block, one that writes the file named
    in the text before it; and one that runs all `python` blocks as one program, at the last block's place."""
    found: list[str] = []
    programs: list[str] = []
    for before, kind, block in re.findall(r"(.*?)^```(\w*)\n(.*?)^```$", text, re.M | re.S):
        if kind == "sh":
            found += [line for line in block.splitlines() if line and not line.startswith("#")]
        elif kind == "json":
            file = re.findall(r"`([\w-]+\.json)`", before)[-1]
            found.append(f"cat >{file} <<'END'\n{block}END")
        elif kind == "python":
            programs.append(block)
            found = [command for command in found if not command.startswith("cat >page.py")]
            found.append(f"cat >page.py <<'END'\n{''.join(programs)}END\n\"$PYTHON\" page.py")
    return found


def script(page: list[str]) -> str:
    """Returns a shell script of the commands, which reports the start and the status of each at file descriptor 3."""
    lines = []
    for number, command in enumerate(page):
        if "--serve" in command:
            command = f"timeout --signal=INT {SERVED} {command.partition(' #')[0]}; [ $? = 124 ]"
        elif command.startswith("timeout"):  # too short to finish
            command = f"{command.partition(' #')[0].replace(' 300 ', ' 0.2 ')}; [ $? = 124 ]"
        if "KEEP_GOING=1" in command:  # the exit status at the end reports a refuted module
            command = f"{command.partition(' #')[0]}; [ $? = 2 ]"
        lines.append(f"echo begin {number} >&3\n{command}\necho end {number} $? >&3\n")
    return "".join(lines)


def prepare(folder: pathlib.Path) -> None:
    """Writes the files that the tutorials expect from the reader."""
    for name in ("cornell.obj", "cornell.mtl"):
        shutil.copy(ROOT / "scenes" / name, folder / name.replace("cornell.obj", "model.obj"))
    (folder / "rays.csv").write_text("0,1,5,0,0,-1\n")


def run(name: str, page: list[str], folder: pathlib.Path, environment: dict[str, str]) -> list[str]:
    """Runs the commands of a page in `folder` and returns those that failed."""
    log = ROOT / "build" / f"commands-{pathlib.Path(name).stem}.log"
    said, saying = os.pipe()
    with log.open("w") as out, os.fdopen(said) as told:
        shell = subprocess.Popen(["bash", "-c", f"exec 3>&{saying}\n{script(page)}"], cwd=folder, env=environment, pass_fds=[saying],
                                 stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT)
        os.close(saying)
        failed = []
        for event in told:
            kind, number, *status = event.split()
            command = page[int(number)].splitlines()[0]
            if kind == "begin":
                print(f"{name}: {command}", flush=True)
            elif status != ["0"]:
                failed.append(f"{name}: {command}: ended with status {status[0]}; see {log.relative_to(ROOT)}")
                print(failed[-1], file=sys.stderr, flush=True)
        if shell.wait() and not failed:
            failed.append(f"{name}: the shell ended with status {shell.returncode}; see {log.relative_to(ROOT)}")
            print(failed[-1], file=sys.stderr)
    return failed


def quick(name: str, text: str, folder: pathlib.Path) -> list[str]:
    """Returns the quick commands of a page, with small pictures, and with the C++ engine if the page builds only that."""
    for entry in ROOT.iterdir():
        if entry.name not in PROGRAMS and not entry.name.startswith("."):
            (folder / entry.name).symlink_to(entry)
    engine = "--engine cpu" if "\nmake cpu" in text else ""
    for program in PROGRAMS:
        more = f'case "$*" in *--size*|*--help*) ;; *) set -- "$@" --size 64x48 ;; esac\ncase "$*" in *--engine*) ;; *) set -- "$@" {engine} ;; esac\n'
        (folder / program).write_text(f'#!/bin/sh\n{more if program == "render" else ""}exec {shlex.quote(str(ROOT / "build" / program))} "$@"\n')
        (folder / program).chmod(0o755)
        (folder / f"raygate-{program}").symlink_to(program)  # as pip installs it
    prepare(folder)
    page = [command for command in commands(text) if command.split("\n")[-1].startswith(QUICK) or command.startswith(QUICK)]
    return run(name, page, folder, os.environ | {"PYTHON": sys.executable, "PYTHONPATH": str(ROOT / "build/host/python"), "PATH": f"{folder}:{os.environ['PATH']}"})


def main() -> int:
    """Runs the commands of the pages; returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("pages", nargs="*", default=PAGES)
    given = parser.parse_args()
    failed = []
    if not given.quick:
        clone = ROOT / "build/commands"
        shutil.rmtree(clone, ignore_errors=True)
        subprocess.run(["git", "clone", "-q", ROOT, clone], check=True)
        prepare(clone)
    for name in given.pages:
        text = (ROOT / name).read_text()
        if given.quick:
            with tempfile.TemporaryDirectory() as folder:
                failed += quick(name, text, pathlib.Path(folder))
        else:
            failed += run(name, commands(text), clone, os.environ | {
                "HOME": str(clone / "build/home"), "PYTHON": str(clone / "build/home/raygate-python/bin/python3")})
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
