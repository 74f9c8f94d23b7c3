"""`python3 -m host.lab TARGET`: measures what `make TARGET` reports and writes build/reports/TARGET/report.md.

A target is a module of host/lab/targets. `PARTS` gives the steps of each part, `PAGE` the Jinja2 template of its report, `values` the
values that the template needs besides the rows, `failures` the errors in the rows (exit status 1), and `own_folder` the report's folder,
for a target with several reports.
"""

import argparse
import importlib
import pathlib
import shlex
import shutil
import subprocess
import sys

from host.lab import rows as kept, steps
from host.lab.report import document
from host.lab.rows import KEPT, ROOT, processors
from synth import tables, tools

REPORTS = ROOT / "build" / "reports"
PUBLISHED = ROOT / "host" / "lab" / "results"
TARGETS = ("stress", "bench", "peers", "speed", "core", "variant")


def arguments() -> argparse.Namespace:
    """Returns the parsed command line."""
    parser = argparse.ArgumentParser(prog="host.lab", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("target", choices=TARGETS)
    parser.add_argument("--only", default="", metavar="PART,PART", help="some of the target's parts")
    parser.add_argument("--quick", action="store_true", help="small pictures, few repeats")
    parser.add_argument("--scenes", default="", metavar="'NAME NAME'", help="peers: some of the scenes; variant: one")
    parser.add_argument("--tests", type=int, help="stress: tests in each suite")
    parser.add_argument("--seed", type=int, default=1, help="stress (1)")
    parser.add_argument("--jobs", type=int, default=processors(), help="stress: suites at once (all processors)")
    parser.add_argument("--variant", nargs="*", default=[], metavar="FRAC_WIDTH=15", help="variant: what is not as in binary32")
    parser.add_argument("--command", type=str.strip, default="", help="the command of make, for the report")
    parser.add_argument("--publish", action="store_true", help="write the report into host/lab/results too")
    return parser.parse_args()


def publish(name: str, folder: pathlib.Path, text: str) -> None:
    """Copies a report with its plots and long tables into host/lab/results; removes files that no report uses."""
    (PUBLISHED / f"{name}.md").write_text(tables.unpadded(text))
    for file in [*folder.glob("*.png"), *folder.glob("*.csv")]:
        shutil.copy(file, PUBLISHED)
    shown = "".join(page.read_text() for page in PUBLISHED.glob("*.md"))
    for file in [*PUBLISHED.glob("*.*g"), *PUBLISHED.glob("*.csv")]:
        if file.name not in shown:
            file.unlink()


def run(given: argparse.Namespace) -> int:
    """Measures, writes the report, and returns the exit status: 1 if the rows have errors."""
    target = importlib.import_module(f"host.lab.targets.{given.target}")
    parts = given.only.split(",") if given.only else list(getattr(target, "USUAL", target.PARTS))
    unknown = set(parts) - set(target.PARTS)
    if unknown:
        raise ValueError(f"ONLY={','.join(sorted(unknown))}: expected some of {', '.join(target.PARTS)}, with commas between")
    if given.publish and (given.only or given.quick or given.scenes or given.tests):
        raise ValueError("--publish: expected a whole run, without --only, --quick, --scenes and --tests")
    file = KEPT / f"{'-'.join([given.target, *(parts if given.only else [])])}.jsonl"
    found = steps.run(given.target, [step for part in parts for step in target.PARTS[part](given)],
                      given.command, given.jobs if given.target == "stress" else 1)
    found[0] |= {"quick": given.quick, "command": given.command}
    kept.write(file, target.finish(found) if hasattr(target, "finish") else found)
    rows = kept.read(file)
    folder = REPORTS / given.target / (target.own_folder(rows) if hasattr(target, "own_folder") else "")
    folder.mkdir(parents=True, exist_ok=True)
    values = target.values(rows, folder)
    text = document.render(target.PAGE, folder, rows, **values) + document.measured(rows[0])
    (folder / "report.md").write_text(text)
    if given.publish:
        publish(given.target, folder, text)
    print(text, f"Report: {folder.relative_to(ROOT)}/report.md; rows: {file.relative_to(ROOT)}", sep="\n")
    wrong = target.failures(rows) if hasattr(target, "failures") else []
    print("".join(f"error: {line}\n" for line in wrong), end="", file=sys.stderr)
    return 1 if wrong else 0


@tools.command("error")
def main() -> int:
    """Runs the command line. Returns exit status 2 for user errors."""
    try:
        return run(arguments())
    except subprocess.CalledProcessError as error:  # the command has printed the error, or its standard error was captured
        print(error.stderr or "", end="", file=sys.stderr)
        raise ValueError(f"{shlex.join(map(str, error.cmd))}: ended with status {error.returncode}") from error


if __name__ == "__main__":
    sys.exit(main())
