"""What `.ci/run` checks at this commit, by guards.toml.

usage: guards.py plan            prints each guard and what of it runs
       guards.py due GUARD       exit status 0 if GUARD runs, 1 if not
       guards.py cases GUARD     of the cases on standard input, one per line, those that run
       guards.py rooms           prints the rooms of the address sanitizer, one per line
       guards.py skipped BUILD   a regular expression of the tests of a build that do not run
       guards.py passed COMMIT   records that everything passed at this commit
       guards.py try [GUARD ...] puts each guard's fault into a clone, in build/guards, and shows that the guard refuses it

A guard runs in full if a file that it guards differs from the commit that last passed on this machine, or if none is known.
All guards do if the set-up of builds or checks differs. Otherwise a guard with `turns` runs one case in `turns`, others at the next run.
"""

import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
TABLE = tomllib.loads((ROOT / ".ci/guards.toml").read_text())
CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache")
STATE = pathlib.Path(os.environ.get("RAYGATE_CI_STATE") or CACHE / "raygate" / "ci.json")


# Path prefixes of files that all guards depend on.
SET_UP = (".ci/", ".clang-tidy", "CMakeLists.txt", "host/CMakeLists.txt", "sim/verilate.cmake")


def git(*words: str) -> str:
    return subprocess.run(["git", *words], cwd=ROOT, check=True, capture_output=True, text=True).stdout


def last_passed() -> dict:
    """Returns the commit that last passed on this machine (None if unknown) and the number of runs before this run."""
    state = json.loads(STATE.read_text()) if STATE.exists() else {}
    known = state and subprocess.run(["git", "cat-file", "-e", f"{state['commit']}^{{commit}}"], cwd=ROOT,
                                     capture_output=True, check=False).returncode == 0
    return state if known else {"commit": None, "runs": int(git("rev-parse", "HEAD")[:8], 16)}


def changed(commit: str | None) -> list[str]:
    """Returns the files that differ from `commit`, including deleted and new ones; all files if `commit` is None."""
    if commit is None:
        return git("ls-files").splitlines()
    return [*git("diff", "--name-only", commit).splitlines(),
            *git("ls-files", "--others", "--exclude-standard").splitlines()]


def is_touched(guard: dict, files: list[str]) -> bool:
    return any(file.startswith(tuple(guard["files"])) for file in files)


def room(file: str) -> str:
    """Returns a file's room: host/light for host/light/lights.h and host/CMakeFiles/raygate_light.dir/..., sim for sim/model.h."""
    parts = re.sub(r"^host/CMakeFiles/raygate_(\w+)\.dir", r"host/\1", file).split("/")
    return "/".join(parts[:2]) if parts[0] == "host" else parts[0]


class Plan:
    """Selects the guards and cases that run, by the changed files and the number of runs before this run."""

    def __init__(self, files: list[str], runs: int) -> None:
        self.files = files
        self.runs = runs

    def runs_in_full(self, name: str) -> bool:
        return "turns" not in TABLE[name] or is_touched({"files": [*SET_UP, *TABLE[name]["files"]]}, self.files)

    def has_turn(self, name: str, case: str) -> bool:
        """Returns whether it is the case's turn in this run: every case has one turn in `turns` consecutive runs."""
        turns = TABLE[name]["turns"]
        return int(hashlib.sha256(case.encode()).hexdigest(), 16) % turns == self.runs % turns

    def cases(self, name: str, cases: list[str]) -> list[str]:
        """Returns those of `cases` that run."""
        if any(file.startswith(SET_UP) for file in self.files):
            return cases
        guard, touched = TABLE[name], {room(file) for file in self.files}
        if guard.get("by_room"):
            return [case for case in cases if room(case) in touched or self.has_turn(name, case)]
        if "rooms" in guard:
            first = min((place for place, case in enumerate(guard["rooms"]) if f"host/{case}" in touched), default=len(cases))
            return [case for place, case in enumerate(guard["rooms"]) if place >= first or self.has_turn(name, case)]
        return cases if self.runs_in_full(name) else [case for case in cases if self.has_turn(name, case)]

    def skipped(self, tests: list[str]) -> list[str]:
        """Returns those of ctest's `tests` that do not run."""
        skipped = []
        for name, guard in TABLE.items():
            if "tests" in guard:
                matching = [test for test in tests if re.search(guard["tests"], test)]
                run = set(self.cases(name, matching))
                skipped += [test for test in matching if test not in run]
        return skipped


def tests_of(build: str) -> list[str]:
    """Returns the names of a build's tests."""
    listed = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout
    return [test["name"] for test in json.loads(listed)["tests"]]


def refuses(name: str, clone: pathlib.Path, state: dict) -> bool:
    """Returns whether a guard, run in this state, fails in the clone."""
    file = clone / "build/state.json"
    file.write_text(json.dumps(state))
    environment = os.environ | {"RAYGATE_CI": "1", "RAYGATE_CI_STATE": str(file)}
    guard = TABLE[name]
    command = guard.get("run")
    if command is None:
        touched = subprocess.run(["git", "diff", "--name-only", state["commit"]], cwd=clone, check=True,
                                 capture_output=True, text=True).stdout.splitlines()
        tests = [test for test in tests_of(str(clone / "build")) if re.search(guard["tests"], test)]
        tests = [test for test in Plan(touched, state["runs"]).cases(name, tests)
                 if re.search(guard["fault"].get("within", ""), test)]
        if not tests:
            return False
        command = f"ctest --test-dir build -R '{'|'.join(f'^{re.escape(test)}$' for test in tests)}'"
    with (clone / "build" / f"{name}.log").open("w") as log:
        return subprocess.run(command, cwd=clone, env=environment, shell=True, stdout=log, stderr=subprocess.STDOUT,
                              check=False).returncode != 0


def try_faults(names: list[str]) -> int:
    """Commits each guard's fault in a clone. The guard must fail at this commit. A guard with turns must also fail within `turns` runs
    after this commit, with no further file touched. Returns 1 if a guard does not fail."""
    clone = ROOT / "build/guards"
    if not clone.exists():
        subprocess.run(["git", "clone", "-q", ROOT, clone], check=True)
        (clone / "build").mkdir()
        (clone / "build/venv").symlink_to(ROOT / "build/venv")
    in_clone = {"cwd": clone, "check": True, "capture_output": True, "text": True}
    head = git("rev-parse", "HEAD").strip()
    subprocess.run(["git", "fetch", "-q", ROOT, head], **in_clone)
    subprocess.run(["git", "checkout", "-q", "--force", head], **in_clone)
    subprocess.run(["make", "everything"], **in_clone)
    missed = 0
    for name in names:
        fault = TABLE[name]["fault"]
        file = clone / fault["file"]
        text = file.read_text()
        if fault["find"] not in text:
            raise ValueError(f"{name}: {fault['file']} has no {fault['find']!r}")
        file.write_text(text.replace(fault["find"], fault["put"], 1))
        subprocess.run(["git", "-c", "user.name=fault", "-c", "user.email=fault", "commit", "-qam", name], **in_clone)
        if "build" in fault:
            subprocess.run(["cmake", "--build", "build", "--target", fault["build"]], **in_clone)
        outcome = "refused" if refuses(name, clone, {"commit": head, "runs": 0}) else "MISSED"
        if turns := TABLE[name].get("turns"):
            later = subprocess.run(["git", "rev-parse", "HEAD"], **in_clone).stdout.strip()
            runs = [run for run in range(turns) if refuses(name, clone, {"commit": later, "runs": run})]
            outcome += f"; untouched: refused in {len(runs)} of {turns} runs" if runs else "; untouched: MISSED"
        missed += "MISSED" in outcome
        print(f"{name:20} {fault['file']:40} {outcome}", flush=True)
        subprocess.run(["git", "reset", "-q", "--hard", head], **in_clone)
    return 1 if missed else 0


def main() -> int:
    state = last_passed()
    plan = Plan(changed(state["commit"]), state["runs"])
    match sys.argv[1:]:
        case ["plan"]:
            since = f"{len(plan.files)} files differ from {state['commit'][:7]}" if state["commit"] else "no run has passed here"
            print(f"{since}:")
            for name, guard in TABLE.items():
                by_room = state["commit"] and ("by_room" in guard or "rooms" in guard)
                part = ("touched rooms, and of others 1 in 3" if by_room else
                        "in full" if plan.runs_in_full(name) else f"1 case in {guard['turns']}")
                print(f"  {name:20} {part}")
        case ["due", name]:
            return 0 if plan.cases(name, [name]) else 1
        case ["cases", name]:
            print(*plan.cases(name, sys.stdin.read().splitlines()), sep="\n")
        case ["skipped", build]:
            print("|".join(f"^{re.escape(test)}$" for test in plan.skipped(tests_of(build))))
        case ["rooms"]:
            print(*TABLE["address-sanitizer"]["rooms"], sep="\n")
        case ["passed", commit]:
            STATE.parent.mkdir(parents=True, exist_ok=True)
            STATE.write_text(json.dumps({"commit": commit, "runs": plan.runs + 1}))
        case ["try", *names]:
            return try_faults(names or list(TABLE))
        case _:
            print(__doc__.strip(), file=sys.stderr)
            return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
