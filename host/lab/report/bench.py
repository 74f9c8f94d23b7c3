"""`make bench`: measures, and what follows from the measured rows."""

import json
import pathlib
import re
import shlex
import statistics
import subprocess
import sys
import time

from host.lab.report import claims, costs, machine, rows as kept, runs
from host.lab.report.rows import KEPT, ROOT

LAB = ROOT / "build" / "lab"


def lab(name: str, *words: str) -> list[dict]:
    """The rows of a command of the lab; its progress goes to standard error."""
    share([["--results", part(name), *words]], "")
    return kept.read(part(name))


def make_spheres(quick: bool) -> None:
    """The spheres of `triangles`, where they aren't yet."""
    for fineness in runs.FINENESS[quick]:
        file = runs.sphere(fineness)
        if not file.exists():
            file.parent.mkdir(parents=True, exist_ok=True)
            subprocess.run([sys.executable, "-B", ROOT / "scenes" / "make_sphere.py", file,
                            "--fineness", str(fineness)], check=True)


def add_flip(pictures: list[dict]) -> None:
    """FLIP of each picture that is compared with another: Andersson et al., "FLIP: a difference
    evaluator for alternating images", 2020, its authors' own implementation (PyPI flip-evaluator),
    at its default of 67 pixels a degree."""
    import flip_evaluator  # which tests of the tables do without
    import numpy
    from matplotlib import image

    def shown(stem: str) -> numpy.ndarray:
        return numpy.asarray(image.imread(ROOT / f"{stem}.png"), dtype=numpy.float32)[..., :3]

    for row in pictures:
        if row.get("against"):
            error_map, flip, _ = flip_evaluator.evaluate(
                shown(row["against"]), shown(row["picture"]), "LDR")
            row |= {"flip": float(flip), "map": f"{row['picture']}-flip.png"}
            image.imsave(ROOT / row["map"], numpy.clip(error_map, 0, 1))


def simulation() -> list[dict]:
    """The simulated units' tests per second, and their instructions where valgrind counts them."""
    command = "build/sim/unit_bench"
    done = subprocess.run([ROOT / command], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    row = (r"(?P<unit>.+?) +(?P<arithmetic>\S+) +(?P<lanes>\S+) +(?P<hits_percent>[\d.]+) +"
           r"(?P<tests_per_second>\d+)(?: +(?P<instructions>\d+))?$")
    return [{"table": "simulation", **match.groupdict(), "command": command}
            for match in re.finditer(row, done.stdout, re.MULTILINE)]


def share(commands: list[list[object]], launcher: str) -> None:
    """Runs `build/lab` with these words, command by command; `launcher`, "mpirun -n 4" or the like, shares them
    among ranks, which write into the same folders."""
    if not launcher:
        for words in commands:
            subprocess.run([LAB, *words], cwd=ROOT, stdout=sys.stderr, check=True)
        return
    file = KEPT / "share.txt"
    file.parent.mkdir(parents=True, exist_ok=True)
    # 1: something was judged to be wrong, which the rows say, too.
    file.write_text("".join(shlex.join(map(str, (LAB, *words))) + " || test $? = 1\n" for words in commands))
    subprocess.run([*shlex.split(launcher), ROOT / "build" / "share", file], cwd=ROOT, stdout=sys.stderr, check=True)


def part(name: str) -> pathlib.Path:
    """Where a command of many keeps its rows."""
    return KEPT / f"part-{name}.jsonl"


def share_stress(tests: int, seed: int, launcher: str) -> None:
    """All suites of `lab stress`, each a command: build/results/stress.jsonl, for `lab stress` to judge."""
    suites = subprocess.run([LAB, "stress", "--list"], stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()
    share([["--results", part(f"stress-{suite}"), "stress", "--suite", suite, "--tests", tests, "--seed", seed]
           for suite in suites], launcher)
    found = [row for suite in suites for row in kept.read(part(f"stress-{suite}"))]
    bounds = kept.of(found, "bounds")[:1]  # the same in each
    kept.write(KEPT / "stress.jsonl", bounds + kept.of(found, "stress"))


def race(quick: bool) -> list[dict]:
    """Error against time: as many samples in each pixel, --error, and Mitsuba, as `make peers` has them."""
    from host.lab.peers import measure as peers  # needs Mitsuba, which tests of the tables do without

    scenes = ["cornell"] if quick else ["cornell", "lanterns"]
    return [row for rows in peers.measure(scenes, quick, 2 if quick else 3, 128 if quick else 512, ROOT / "render", {1})
            for row in rows]


def measure(quick: bool, launcher: str = "") -> list[dict]:
    """Everything."""
    start = time.monotonic()
    about = {**machine.describe(ROOT), "quick": quick,
             "command": "make bench" + (" QUICK=1" if quick else "")}
    (ROOT / runs.PICTURES).mkdir(parents=True, exist_ok=True)
    variants = lab("variants", "variants")
    found = [*variants, *lab("checks", "check", "--tests", "20000" if quick else "1000000")]
    make_spheres(quick)
    commands = []
    for name, section in runs.SECTIONS.items():
        file = KEPT / f"runs-{name}.json"
        file.write_text(json.dumps([{"section": name, **run} for run in section(variants, quick)]))
        commands.append(["--results", part(name), "pictures", "--runs", file])
    share(commands, launcher)
    found += [row for name in runs.SECTIONS for row in kept.read(part(name))]
    add_flip(kept.of(found, "pictures"))
    print(f"[{time.monotonic() - start:5.0f} s] race: {race.__doc__}", file=sys.stderr)
    found += race(quick)
    found += [] if quick else simulation()
    found += claims.table(ROOT, found)
    found += costs.synthesis(variants, machine.processors(), measure=not quick)
    found += costs.energies()
    return [{**about, "seconds": time.monotonic() - start}, *found]


def frames(rows: list[dict]) -> list[dict]:
    """A copy of each picture's row of the section `variants`, with its variant's columns, and

    clocks      of the frame: its tests through the unit, times the clocks per test of the variant's
                simulation (of binary32's where it has no hardware: then `clocks_modelled`)
    wrong, doubtful          tests per million
    area, period_ns, frame_ms, area_time    where synthesis knows the unit
    energy_uj   of the cores, where it was simulated
    """
    pictures = kept.of(rows, "pictures", section="variants")
    rate = {row["variant"]: row["clocks"] / row["unit_tests"] for row in pictures
            if row["engine"] == "unit" and row["unit_tests"]}
    variants = {row["variant"]: row for row in kept.of(rows, "variants")}
    synthesis, energies = kept.of(rows, "synthesis"), kept.of(rows, "energy")
    found = []
    for row in pictures:
        if row["engine"] == "unit":
            continue
        variant = variants[row["variant"]]
        usual = "serial" if variant["unit"] == "serial" else "binary32"
        clocks_per_test = rate.get(row["variant"]) or rate[usual]
        judged = row["decisions"]
        tests = max(judged["tests"], 1)
        frame = {**row, "scene": kept.scene_name(row), **{key: variant[key] for key in
                 ("unit", "exponent_bits", "digits", "doubts")},
                 "wrong": 1e6 * (judged["wrong_hits"] + judged["wrong_misses"]) / tests,
                 "doubtful": 1e6 * judged["doubts"] / tests,
                 "point": judged["point_ulp"]["p99"],
                 "clocks": row["unit_tests"] * clocks_per_test,
                 "clocks_modelled": row["variant"] not in rate}
        cost = costs.cost(synthesis, variant)
        if cost:
            frame |= {"area": cost.area, "period_ns": cost.period_ns,
                      "frame_ms": frame["clocks"] * cost.period_ns * 1e-6}
            frame["area_time"] = cost.area * frame["frame_ms"]
        spent = costs.energy(energies, variant)
        if spent is not None:
            frame["energy_uj"] = spent * row["unit_tests"] / 1000
        found.append(frame)
    return found


def median_seconds(row: dict) -> float:
    """Of the repeats."""
    from host.lab.report.statistics import times
    return statistics.median(times(row))
