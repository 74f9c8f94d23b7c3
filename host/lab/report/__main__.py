"""`python3 -m host.lab.report`: what `make bench`, `make stress`, `make core`, `make profile`, `make phase-times`,
`make scaling`, `make adaptive` and `make trace-rates` run."""

import argparse
import pathlib
import shlex
import shutil
import statistics
import subprocess
import sys

from host.lab.report import (adaptive, bench, bench_report, compare, core_report, document, phase_times, profile, scaling,
                             stress_report, trace_rates)
from host.lab.report import rows as kept
from host.lab.report.rows import KEPT, ROOT

REPORTS = ROOT / "build" / "reports"
PUBLISHED = ROOT / "host" / "lab" / "results"
# A run of all suites with so many tests in each may be published.
ENOUGH = 1_000_000


def arguments() -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(prog="report", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("bench", help="run time against error: build/reports/bench/report.md")
    command.add_argument("--quick", action="store_true", help="small pictures, few repeats")
    command.add_argument("--base", type=pathlib.Path, metavar="OLD.jsonl",
                         help="older rows: says what got slower or less accurate since")
    command.add_argument("--report-only", action="store_true",
                         help="draw build/results/bench.jsonl again, measuring nothing")
    command.add_argument("--launcher", default="", help="shares the sections among ranks: 'mpirun -n 4'")
    shared = commands.add_parser("share-stress", help="the suites of `lab stress`, shared among ranks")
    shared.add_argument("--launcher", required=True, help="'mpirun -n 4' or the like")
    shared.add_argument("--tests", type=int, required=True)
    shared.add_argument("--seed", type=int, required=True)
    stress = commands.add_parser("stress", help="build/results/stress.jsonl as a report")
    core = commands.add_parser("core", help="build/results/core-*.jsonl as a report")
    for publishing in (command, stress, core):
        publishing.add_argument("--publish", action="store_true",
                                help="write the report into host/lab/results/ as well")
    command = commands.add_parser("profile", help="hit tests, departures and shading in pictures by ./render")
    command.add_argument("scenes", nargs="+")
    command.add_argument("--render", type=pathlib.Path, default=ROOT / "render", metavar="PROGRAM")
    command.add_argument("--size", default="128x96")
    command.add_argument("--spp", default="4")
    command = commands.add_parser("phase-times", help="load, tree, render, write: how long each takes ./render")
    command.add_argument("scenes", nargs="+")
    command.add_argument("--render", type=pathlib.Path, default=ROOT / "render", metavar="PROGRAM")
    command.add_argument("--before", type=pathlib.Path, metavar="PROGRAM", help="an older one to print in brackets")
    command.add_argument("--size", default="640x480")
    command.add_argument("--repeats", type=int, default=9)
    command = commands.add_parser("adaptive", help="time with --error beside uniform --spp, at equal errors")
    command.add_argument("scenes", nargs="+")
    command.add_argument("--render", type=pathlib.Path, default=ROOT / "render", metavar="PROGRAM")
    command.add_argument("--size", default="96x72")
    command.add_argument("--error", type=float, default=2.0, help="of ./render, with --most as its --spp")
    command.add_argument("--most", type=int, default=256)
    command.add_argument("--counts", type=int, nargs="+", default=[16, 32, 64, 128, 256], help="uniform samples")
    command.add_argument("--reference", type=int, default=2048, help="samples of the picture that is the truth")
    command.add_argument("--seeds", type=int, default=2)
    command = commands.add_parser("scaling", help="time by ranks, measured and modelled: build/reports/scaling/report.md")
    command.add_argument("scenes", nargs="+", help="OBJ files")
    command.add_argument("--render", type=pathlib.Path, default=ROOT / "render", metavar="PROGRAM")
    command.add_argument("--repeats", type=int, default=5)
    command.add_argument("--report-only", action="store_true", help="draw what was measured last again")
    command.add_argument("--publish", action="store_true",
                         help="write the report into host/lab/results/ as well")
    command = commands.add_parser("trace", help="rays per second of ./trace")
    command.add_argument("scenes", nargs="+", help="OBJ files")
    command.add_argument("--trace", type=pathlib.Path, default=ROOT / "trace", metavar="PROGRAM")
    command.add_argument("--rays", type=int, default=1_000_000)
    return parser.parse_args()


def write(rows: list[dict], build: object, name: str, publish: bool) -> None:
    """NAME's report into build/reports/NAME/; with `publish`, into host/lab/results/ too."""
    folder = REPORTS / name
    folder.mkdir(parents=True, exist_ok=True)
    text = build(rows, folder)
    document.write(text, folder)
    if publish:
        PUBLISHED.mkdir(exist_ok=True)
        (PUBLISHED / f"{name}.md").write_text(text)
        for file in folder.glob("*.png"):
            shutil.copy(file, PUBLISHED)
        shown = "".join(page.read_text() for page in [PUBLISHED.parent / "README.md", *PUBLISHED.glob("*.md")])
        for file in PUBLISHED.glob("*.*g"):  # pictures of older reports
            if file.name not in shown:
                file.unlink()
    print(f"Report: build/reports/{name}/report.md, and report.html beside it")


def run_bench(given: argparse.Namespace) -> int:
    """1 where a reference model is not its hardware."""
    base = kept.read(given.base) if given.base else None
    file = KEPT / "bench.jsonl"
    if not given.report_only:
        kept.write(file, bench.measure(given.quick, given.launcher))
    rows = kept.read(file)
    write(rows, bench_report.build, "bench", given.publish)
    table = kept.comma_separated(kept.of(rows, "pictures"))
    for folder in (REPORTS / "bench", *([PUBLISHED] if given.publish else [])):
        (folder / "results.csv").write_text(table)
    if base:
        print("\n".join(compare.compare(base, rows)))
    wrong = [row for row in kept.of(rows, "checks") if row["difference"] != "none"]
    for row in wrong:
        print(f"error: {row['variant']}: model and hardware differ: {row['difference']}",
              file=sys.stderr)
    return 1 if wrong else 0


def run_stress(given: argparse.Namespace) -> int:
    """The verdict is `lab stress`'s."""
    rows = kept.read(KEPT / "stress.jsonl")
    tests = next(row["run"]["tests"] for row in rows)
    if given.publish and tests < ENOUGH:
        print(f"error: found {tests:,} tests in each suite, expected {ENOUGH:,} to publish",
              file=sys.stderr)
        return 2
    write(rows, stress_report.build, "stress", given.publish)
    return 0


def run_core(given: argparse.Namespace) -> int:
    """The rows of the runs that `make core` makes, by the names of their files."""
    rows = [{**row, "run": run} for run, file in (("scenes", "core"), ("in flight", "core-in-flight"),
                                                  ("cores", "core-cores"), ("wide", "core-wide"),
                                                  ("records", "core-records"))
            for row in kept.read(KEPT / f"{file}.jsonl")]
    write(rows, core_report.build, "core", given.publish)
    return 0


def share_stress(given: argparse.Namespace) -> int:
    """For `lab stress` to judge."""
    bench.share_stress(given.tests, given.seed, given.launcher)
    return 0


def run_profile(given: argparse.Namespace) -> int:
    """Prints the table and keeps its rows."""
    light = ["--integrator", "path", "--size", given.size, "--spp", given.spp]
    rows = [profile.row(given.render.resolve(), scene, light) for scene in given.scenes]
    kept.write(KEPT / "profile.jsonl", rows)
    print(document.table(
        {"scene": "", "triangles": ",", "rays": ",", "instructions per ray": ",.0f", "hit tests, %": ".1f",
         "departures, %": ".1f", "shading, %": ".1f", "exact decisions, %": ".2f", "doubts, % of tests": ".4f"},
        [[kept.scene_name(row), row["triangles"], row["rays"], row["instructions_per_ray"], row["hit_tests"],
          row["departures"], row["shading"], row["doubts"], row["edge_doubts_percent"]] for row in rows]))
    return 0


def run_phase_times(given: argparse.Namespace) -> int:
    """Prints the table, the fastest of each phase's runs, and keeps the rows."""
    programs = [given.render.resolve()] + ([given.before.resolve()] if given.before else [])
    rows = phase_times.measure(programs, given.scenes, ["--integrator", "whitted", "--spp", "1", "--size", given.size],
                          given.repeats)
    kept.write(KEPT / "phase_times.jsonl", rows)

    def cell(scene: str, phase: str) -> str:
        now, *before = (f"{1000 * min(row['seconds'][phase]):.0f}" for row in kept.of(rows, "phase_times", scene=scene))
        return now + "".join(f" ({old})" for old in before)

    print(document.table(
        {"scene": "", "triangles": ","} | {f"{phase}, ms": "" for phase in phase_times.PHASES},
        [[kept.scene_name(row), row["triangles"], *(cell(row["scene"], phase) for phase in phase_times.PHASES)]
         for row in kept.of(rows, "phase_times", program=0)]))
    return 0


def run_scaling(given: argparse.Namespace) -> int:
    """ValueError where numbers of ranks differ in a byte."""
    file = KEPT / "scaling.jsonl"
    if not given.report_only:
        kept.write(file, scaling.measure(given.render.resolve(), given.scenes, given.repeats))
    write(kept.read(file), scaling.build, "scaling", given.publish)
    return 0


def run_trace(given: argparse.Namespace) -> int:
    """Prints the table and keeps its rows."""
    rows = [row for scene in given.scenes for row in trace_rates.rows(given.trace.resolve(), scene, given.rays)]
    kept.write(KEPT / "trace.jsonl", rows)
    print(document.table(
        {"scene": "", "hits": "", "rays": ",", "rows that hit": ",", "rays/s": ","},
        [[kept.scene_name(row), row["kind"], row["rays"], row["hits"], row["rays_per_second"]] for row in rows]))
    return 0


def run_adaptive(given: argparse.Namespace) -> int:
    """Prints the table and keeps its rows."""
    wanted = {key: getattr(given, key) for key in ("size", "error", "most", "counts", "reference", "seeds")}
    rows = []
    for scene in given.scenes:
        rows.append(adaptive.row(given.render.resolve(), scene, wanted))
        kept.write(KEPT / "adaptive.jsonl", rows)
    ratios = [[row[f"{measure}_ratio"] for row in rows] for measure in adaptive.MEASURES]
    print(document.table(
        {"scene": "", "samples a pixel": ".1f", "seconds": ".3g", "RMSE": ".5f", "FLIP": ".4f", "bias, %": ".2f",
         "samples of equal RMSE": ".0f", "of equal FLIP": ".0f", "time over that of equal RMSE": ".2f",
         "over that of equal FLIP": ".2f"},
        [[kept.scene_name(row), row["adaptive"]["samples"], row["adaptive"]["seconds"], row["adaptive"]["rmse"],
          row["adaptive"]["flip"], 100 * row["adaptive"]["bias"], row["rmse_samples"], row["flip_samples"], row["rmse_ratio"], row["flip_ratio"]]
         for row in rows] + [["median", *[None] * 7, *map(statistics.median, ratios)],
                             ["most", *[None] * 7, *map(max, ratios)]]))
    return 0


def main() -> int:
    """Runs the command line; 2 for what the user can mend."""
    given = arguments()
    commands = {"bench": run_bench, "stress": run_stress, "share-stress": share_stress, "core": run_core,
                "profile": run_profile, "phase-times": run_phase_times, "scaling": run_scaling, "adaptive": run_adaptive,
                "trace": run_trace}
    try:
        return commands[given.command](given)
    except subprocess.CalledProcessError as error:  # which has said why, or had its standard error kept
        print(f"{error.stderr or ''}error: {shlex.join(map(str, error.cmd))}: ended with status {error.returncode}",
              file=sys.stderr)
        return 2
    except FileNotFoundError as error:
        print(f"error: {error.filename}: {error.strerror}", file=sys.stderr)
        return 2
    except (OSError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
