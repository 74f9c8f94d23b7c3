"""`python3 -m host.lab.matrix`: see --help, or host/lab/README.md."""

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import time

from host.lab.matrix import claims, compare, costs, derive, document, machine, report, runs
from synth import tables

ROOT = runs.ROOT
OUT = ROOT / "build" / "bench"
PROGRAM = ROOT / "build" / "picture_bench"


def arguments() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(prog="bench", description=(
        "Run time against error: renders the matrix of scenes, units and arithmetics and writes "
        "report.md, report.html, results.json and results.csv into build/bench/."))
    parser.add_argument("--quick", action="store_true", help="small pictures, few repeats")
    parser.add_argument("--base", type=pathlib.Path, metavar="OLD.json",
                        help="an older results.json: says what got slower or less accurate since")
    parser.add_argument("--report-only", action="store_true",
                        help="draw build/bench/results.json again, measuring nothing")
    parser.add_argument("--publish", action="store_true",
                        help="write the tables and plots of host/lab/results/ again as well")
    return parser.parse_args()


def program(*words: str) -> list[dict]:
    """What picture_bench answers; its progress goes to standard error."""
    done = subprocess.run([PROGRAM, *words], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout)


def make_spheres(quick: bool) -> None:
    """The spheres of `triangles`, where they aren't yet."""
    for fineness in runs.FINENESS[quick]:
        file = runs.sphere(fineness)
        if not file.exists():
            file.parent.mkdir(parents=True, exist_ok=True)
            subprocess.run([sys.executable, "-B", ROOT / "scenes" / "make_sphere.py", file,
                            "--fineness", str(fineness)], check=True)


def measure_section(name: str, wanted: list[dict]) -> list[dict]:
    """The rows of a section, their repeats interleaved."""
    file = OUT / f"runs-{name}.json"
    file.write_text(json.dumps(wanted, indent=1))
    return [{"section": name, **row} for row in program("--runs", str(file))]


def add_image_errors(rows: list[dict]) -> None:
    """`image` for each row with a picture: of `variants` against binary32's of the same scene, of
    `samples` against the last."""
    from host.lab.matrix import pictures  # needs FLIP, which tests don't
    shown = [row for row in rows if row.get("picture")]
    reference = {}
    for row in shown:
        if row["section"] == "samples" or row["variant"] == "binary32":
            reference[row["section"], row["scene"]] = row["picture"]
    for row in shown:
        against = reference[row["section"], row["scene"]]
        if row["picture"] != against:
            stem = ROOT / row["picture"]
            flip_map = stem.with_name(stem.name + "-flip.png")
            row["image"] = {**pictures.errors(ROOT / "build" / "compare", ROOT / against, stem,
                                              flip_map), "map": str(flip_map.relative_to(ROOT))}


def simulation() -> list[dict]:
    """The simulated units' tests a second, and their instructions where valgrind can count them."""
    command = "build/sim/unit_bench"
    done = subprocess.run([ROOT / command], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    row = (r"(?P<unit>.+?) +(?P<arithmetic>\S+) +(?P<lanes>\S+) +(?P<hits>[\d.]+) +(?P<rate>\d+)"
           r"(?: +(?P<count>\d+))?$")
    return [{"unit": match["unit"], "arithmetic": match["arithmetic"], "lanes": match["lanes"],
             "hits_percent": float(match["hits"]),
             "tests_per_second": float(match["rate"]), "command": command,
             "instructions": float(match["count"]) if match["count"] else None}
            for match in re.finditer(row, done.stdout, re.MULTILINE)]


def measure(quick: bool) -> dict:
    """Everything, as one object."""
    start = time.monotonic()
    about = machine.describe(ROOT)
    (OUT / "pictures").mkdir(parents=True, exist_ok=True)
    variants = program("--list")
    checks = program("--check", "20000" if quick else "1000000")
    make_spheres(quick)
    rows = []
    for name, wanted in [
            ("variants", runs.variants(variants, quick)),
            ("samples", runs.samples(variants, quick)), ("engines", runs.engines(variants, quick)),
            ("lanes", runs.lanes(variants, quick)), ("triangles", runs.triangles(variants, quick)),
            ("sizes", runs.sizes(variants, quick)),
            ("threads", runs.threads(variants, quick, machine.processors()))]:
        print(f"[{time.monotonic() - start:5.0f} s] {name}: {runs.SECTIONS[name]}", file=sys.stderr,
              flush=True)
        rows += measure_section(name, wanted)
    add_image_errors(rows)
    synthesis = costs.read(ROOT / "build" / "synth" / "results.json")
    if not quick:
        records, failures = costs.synthesise(variants, machine.processors())
        synthesis = records + synthesis
        print("\n".join(failures), file=sys.stderr)
    return {"command": "make bench" + (" QUICK=1" if quick else ""), "quick": quick,
            "machine": about, "variants": variants, "checks": checks, "rows": rows,
            "simulation": [] if quick else simulation(), "claims": claims.table(ROOT, rows),
            "synthesis": synthesis,
            "seconds": time.monotonic() - start}


def flat(row: dict) -> dict:
    """A row with its nested values as name.name, for CSV."""
    out = {}
    for name, value in row.items():
        if isinstance(value, dict):
            out |= {f"{name}.{inner}": item for inner, item in flat(value).items()}
        else:
            out[name] = value
    return out


def write(results: dict) -> None:
    """The four files."""
    rows = [flat(row) for row in results["rows"]]
    columns = list(dict.fromkeys(name for row in rows for name in row))
    (OUT / "results.csv").write_text(tables.comma_separated(rows, columns))
    blocks = report.build(results, OUT)
    (OUT / "report.md").write_text(document.markdown(blocks, OUT))
    (OUT / "report.html").write_text(document.page(blocks, blocks[0].text))


def publish(results: dict) -> None:
    """The part of the report that the repository keeps."""
    folder = ROOT / "host" / "bench" / "results"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    blocks = report.excerpt(results, folder)
    (folder / "README.md").write_text(document.markdown(blocks, folder))
    for drawn in folder.glob("*.svg"):
        drawn.with_suffix(".png").unlink()  # plots are kept once


def main() -> int:
    """Runs the command line; 2 for what the user can mend."""
    given = arguments()
    file = OUT / "results.json"
    try:
        base = json.loads(given.base.read_text()) if given.base else None
    except (OSError, ValueError) as error:
        print(f"error: {given.base}: {error}", file=sys.stderr)
        return 2
    if given.report_only:
        results = json.loads(file.read_text())
    else:
        results = measure(given.quick)
        file.write_text(json.dumps(results, indent=1) + "\n")
    write(results)
    if given.publish:
        publish(results)
    if base:
        print("\n".join(compare.compare(base, results)))
    wrong = [check for check in results["checks"] if check["difference"]]
    for check in wrong:
        print(f"error: {check['variant']}: twin and hardware differ: {check['difference']}",
              file=sys.stderr)
    print(f"Report: {(OUT / 'report.md').relative_to(ROOT)}, and report.html beside it; "
          f"{results['seconds']:.0f} s")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
