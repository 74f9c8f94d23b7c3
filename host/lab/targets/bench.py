"""`make bench`: run time against error, from the adder to the picture."""

import argparse
import csv
import functools
import json
import pathlib
import re
import statistics
import subprocess
import sys
from collections.abc import Callable

import pandas

from host.lab.bench import costs, runs
from host.lab.machine import processors
from host.lab.report import cards, charts, plots
from host.lab.report.statistics import median_seconds
from host.lab.rows import KEPT, ROOT, grouped, of, read, scene_name
from host.lab.steps import LAB, Step

# The axes of the Pareto plots: key of a frame, label.
COSTS = {"clocks": "clocks per frame", "frame_ms": "ms per frame at the clock of synthesis",
         "area": "area, um2 in OSU 0.35 um", "area_time": "area x ms per frame",
         "energy_uj": "uJ per frame in the cores, OSU 0.35 um"}
ERRORS = {"point": "error of P, 99th percentile, ulp of binary32",
          "wrong": "wrong hit decisions per million tests",
          "rmse": "RMSE of the picture, scene-linear"}
# Pictures that differ by less are not shown: their maps are black.
LEAST_FLIP = 0.00005
# What results.csv holds: column, meaning. A column of nested values is explained by the first part of its name.
COLUMNS = ROOT / "host" / "lab" / "report" / "columns.csv"


@functools.cache
def variants() -> list[dict]:
    """The rows of `lab variants`."""
    subprocess.run([LAB, "--results", KEPT / "variants.jsonl", "variants"], cwd=ROOT, stdout=sys.stderr, check=True)
    return read(KEPT / "variants.jsonl")


def section(name: str) -> Callable[[argparse.Namespace], list[Step]]:
    """The pictures of a section of the report, their repeats interleaved."""
    def steps(given: argparse.Namespace) -> list[Step]:
        (ROOT / runs.PICTURES).mkdir(parents=True, exist_ok=True)
        if name == "triangles":
            make_spheres(given.quick)
        file = KEPT / f"runs-{name}.json"
        file.write_text(json.dumps([{"section": name, **run} for run in runs.SECTIONS[name](variants(), given.quick)]))
        return [Step(name, "pictures", ("pictures", "--runs", file))]
    return steps


def make_spheres(quick: bool) -> None:
    """The spheres of `triangles`, where they aren't yet."""
    for fineness in runs.FINENESS[quick]:
        file = runs.sphere(fineness)
        if not file.exists():
            file.parent.mkdir(parents=True, exist_ok=True)
            subprocess.run([sys.executable, "-B", ROOT / "scenes" / "make_sphere.py", file,
                            "--fineness", str(fineness)], check=True)


def race_steps(given: argparse.Namespace) -> list[Step]:
    """Error against time: as many samples in each pixel, --error, and Mitsuba, as `make peers` has them."""
    from host.lab.peers import measure as peers  # needs Mitsuba, which tests of the tables do without

    scenes = ["cornell"] if given.quick else ["cornell", "lanterns"]
    return [Step("race", scene, measure=lambda scene=scene: peers.measure(scene, given.quick, given.render, {1}))
            for scene in scenes]


def simulation() -> list[dict]:
    """The simulated units' tests per second, and their instructions where valgrind counts them."""
    done = subprocess.run([ROOT / "build/sim/unit_bench"], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    row = (r"(?P<unit>.+?) +(?P<arithmetic>\S+) +(?P<lanes>\S+) +(?P<hits_percent>[\d.]+) +"
           r"(?P<tests_per_second>\d+)(?: +(?P<instructions>\d+))?$")
    return [{"table": "simulation", **match.groupdict(), "command": "build/sim/unit_bench"}
            for match in re.finditer(row, done.stdout, re.MULTILINE)]


PARTS = {
    "checks": lambda given: [Step("checks", "models against hardware",
                                  ("check", "--tests", 20_000 if given.quick else 1_000_000))],
    **{name: section(name) for name in runs.SECTIONS},
    "race": race_steps,
    "simulation": lambda given: [] if given.quick else [Step("simulation", "units", measure=simulation)],
    "synthesis": lambda given: [Step("synthesis", "area and clock", measure=lambda: costs.synthesis(
        variants(), processors(), measure=not given.quick))],
    "energy": lambda given: [Step("energy", "of operations", measure=costs.energies)]}


def judge_pictures(rows: list[dict]) -> list[dict]:
    """With FLIP of each picture that is compared with another: Andersson et al., "FLIP: a difference evaluator for
    alternating images", 2020, its authors' own implementation (PyPI flip-evaluator), at its default of 67 pixels a degree."""
    for row in of(rows, "pictures"):
        if row.get("against"):
            error_map, row["flip"] = plots.flip(*(ROOT / f"{row[key]}.png" for key in ("against", "picture")))
            row["map"] = f"{row['picture']}-flip.png"
            plots.save_pixels(error_map, ROOT / row["map"])
    return rows


def finish(rows: list[dict]) -> list[dict]:
    """With the variants, and the pictures judged."""
    return [rows[0], *variants(), *judge_pictures(rows)[1:]]


def frames(rows: list[dict]) -> list[dict]:
    """A copy of each picture's row of the section `variants`, with its variant's columns, and

    clocks      of the frame: its tests through the unit, times the clocks per test of the variant's
                simulation (of binary32's where it has no hardware: then `clocks_modelled`)
    wrong, doubtful          tests per million
    area, period_ns, frame_ms, area_time    where synthesis knows the unit
    energy_uj   of the cores, where it was simulated
    """
    pictures = of(rows, "pictures", section="variants")
    clocks_a_test = {row["variant"]: row["clocks"] / row["unit_tests"] for row in pictures
                     if row["engine"] == "unit" and row["unit_tests"]}
    known = {row["variant"]: row for row in of(rows, "variants")}
    synthesis, energies = of(rows, "synthesis"), of(rows, "energy")
    found = []
    for row in pictures:
        if row["engine"] == "unit" and not row.get("audit"):  # of the unit alone, for its clocks
            continue
        variant, judged = known[row["variant"]], row["decisions"]
        usual = "serial" if variant["unit"] == "serial" else "binary32"
        tests = max(judged["tests"], 1)
        frame = {**row, "scene": scene_name(row),
                 **{key: variant[key] for key in ("unit", "exponent_bits", "digits", "doubts")},
                 "wrong": 1e6 * (judged["wrong_hits"] + judged["wrong_misses"]) / tests,
                 "doubtful": 1e6 * judged["doubts"] / tests, "point": judged["point_ulp"]["p99"],
                 "clocks": row["unit_tests"] * (clocks_a_test.get(row["variant"]) or clocks_a_test[usual]),
                 "clocks_modelled": row["variant"] not in clocks_a_test}
        cost = costs.cost(synthesis, variant)
        if cost:
            frame |= {"area": cost.area, "period_ns": cost.period_ns, "frame_ms": frame["clocks"] * cost.period_ns * 1e-6}
            frame["area_time"] = cost.area * frame["frame_ms"]
        spent = costs.energy(energies, variant)
        if spent is not None:
            frame["energy_uj"] = spent * row["unit_tests"] / 1000
        found.append(frame)
    return found


def by_scene(rows: list[dict], folder: pathlib.Path) -> dict:
    """Frames by scene, Pareto plots of the first one, and where pictures differ."""
    scenes: dict[str, list] = {}
    for frame in frames(rows):
        scenes.setdefault(frame["scene"], []).append(frame)
    pareto = []
    for error, label in ERRORS.items() if scenes else ():
        scene, mine = next(iter(scenes.items()))
        known = {cost: text for cost, text in COSTS.items() if sum(bool(frame.get(cost)) for frame in mine) > 1}
        pareto.append((charts.pareto(mine, known, error, label, f"{scene}: {label}", folder / f"pareto-{error}.png"), label))
    differences = []
    for scene, mine in scenes.items():
        shown = [(f"{frame['variant']}: FLIP {frame['flip']:.4f}", ROOT / frame["map"])
                 for frame in mine if frame["flip"] >= LEAST_FLIP]
        if shown:
            differences.append((plots.gallery(shown, folder / f"differences-{scene}.png"), scene))
    return {"scenes": scenes, "pareto": pareto, "differences": differences, "cards": cards.of_scenes(scenes) if scenes else None}


def samples(rows: list[dict], folder: pathlib.Path) -> dict | None:
    """Error of path tracing by samples."""
    every = of(rows, "pictures", section="samples")
    if not every:
        return None
    mine = [row for row in every if row.get("against")]
    file, laws = charts.scaling({name: [(row["samples"], row[key]) for row in mine]
                                for name, key in (("RMSE", "rmse"), ("FLIP", "flip"))},
                               "samples per pixel", "error", "Path tracing, Cornell box", folder / "samples.png")
    shown = [(f"{row['samples']} samples: RMSE {row['rmse']:.3f}", ROOT / f"{row['picture']}.png") for row in mine[::2]]
    return {"reference": max(every, key=lambda row: row["samples"]), "rows": mine, "plot": file, "laws": laws,
            "gallery": plots.gallery(shown, folder / "samples-gallery.png")}


def lanes(rows: list[dict], folder: pathlib.Path) -> dict | None:
    """Clocks by lanes; 16 is modelled by the power law of the others."""
    mine = of(rows, "pictures", section="lanes", variant="binary32")
    if not mine:
        return None
    file, laws = charts.scaling({"clocks per frame": [(row["lanes"], row["clocks"]) for row in mine]},
                               "lanes", "clocks", "Clocks by lanes, paper's scene", folder / "lanes.png")
    (law,) = laws.values()
    serial = [{**row, "unit": "the paper's"} for row in of(rows, "pictures", section="lanes", variant="serial")]
    return {"row": mine[0], "plot": file, "law": law, "rows": [*({**row, "unit": "pipelined"} for row in mine), {
        "unit": "pipelined, by the power law", "lanes": 16, "clocks": law.at(16)}, *serial]}


def scaling(rows: list[dict], folder: pathlib.Path) -> list[dict]:
    """Time by triangles, pixels and threads, with exponents."""
    found = []
    for name, axis, x_of in [("triangles", "triangles", lambda row: row["triangles"]),
                             ("sizes", "pixels", lambda row: row["width"] * row["height"]),
                             ("threads", "threads", lambda row: row["threads"])]:
        mine = [{**row, "x": x_of(row)} for row in of(rows, "pictures", section=name)]
        if not mine:
            continue
        series = {"seconds": [(row["x"], median_seconds(row)) for row in mine]}
        if name == "triangles":
            series["hit tests per ray"] = [(row["x"], row["tests"] / row["rays"]) for row in mine]
        file, laws = charts.scaling(series, axis, ", ".join(series), f"By {axis}", folder / f"scaling-{name}.png")
        found.append({"axis": axis, "plot": file, "laws": laws, "rows": mine})
    return found


def comma_separated(rows: list[dict]) -> str:
    """CSV: nested values as name.name; of a list of numbers the median."""
    frame = pandas.json_normalize(rows)
    unknown = {name.split(".")[0] for name in frame.columns} - {row["column"] for row in csv.DictReader(COLUMNS.read_text().splitlines())}
    if unknown:
        raise ValueError(f"columns that nobody explains: {', '.join(sorted(unknown))}")
    return frame.map(lambda value: statistics.median(value) if isinstance(value, list) else value).to_csv(index=False)


def values(rows: list[dict], folder: pathlib.Path) -> dict:
    """What is derived from the rows, and the plots; results.csv has the pictures' rows."""
    from host.lab.targets.peers import error_against_time
    pictures = of(rows, "pictures")
    if pictures:
        (folder / "results.csv").write_text(comma_separated(pictures))
    digits = {row["variant"]: row["digits"] for row in of(rows, "variants")}
    points = [{**row, "guarded": row["point_error"] >= 0, "digits": digits[row["variant"]]}
              for row in of(rows, "pictures", section="points") if row.get("against")]
    races = [(error_against_time(rows, row["scene"], folder / f"race-{row['scene']}.png"), row["scene"])
             for row in of(rows, "references")]
    return {**by_scene(rows, folder), "points": grouped(points, ("scene", "variant"), "guarded"), "races": races,
            "samples": samples(rows, folder), "lanes": lanes(rows, folder), "scaling": scaling(rows, folder),
            "example": pictures[0]["command"] if pictures else "",
            "facts": [{"what": key.replace("_", " "), "which": str(value)} for key, value in rows[0].items() if key != "table"]}


def failures(rows: list[dict]) -> list[str]:
    """Reference models that are not their hardware."""
    return [f"{row['variant']}: model and hardware differ: {row['difference']}"
            for row in of(rows, "checks") if row["difference"] != "none"]
