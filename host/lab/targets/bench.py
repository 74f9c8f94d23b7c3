"""`make bench`: run time against error, from the adder to the image."""

import argparse
import functools
import json
import pathlib
import re
import subprocess
import sys
from collections.abc import Callable

from host.lab.bench import costs, runs
from host.lab.machine import processors
from host.lab.report import plots
from host.lab.rows import KEPT, ROOT, of, read, scene_name
from host.lab.steps import LAB, Step

# Costs on the axes of the Pareto plots: key of a frame, label.
COSTS = {"clocks": "clocks per frame", "frame_ms": "ms per frame at the clock of synthesis",
         "area": "area, um2 in OSU 0.35 um", "area_time": "area x ms per frame",
         "energy_uj": "uJ per frame in the cores, OSU 0.35 um"}
ERRORS = {"point": "error of P, 99th percentile, ulp of binary32",
          "wrong": "wrong hit decisions per million tests",
          "rmse": "RMSE of the picture, scene-linear"}
# Images with smaller differences are omitted, as their maps are black.
LEAST_FLIP = 0.00005


@functools.cache
def variants() -> list[dict]:
    """Returns the rows of `lab variants`."""
    subprocess.run([LAB, "--results", KEPT / "variants.jsonl", "variants"], cwd=ROOT, stdout=sys.stderr, check=True)
    return read(KEPT / "variants.jsonl")


def section(name: str) -> Callable[[argparse.Namespace], list[Step]]:
    """Returns a function that makes the steps of a section: its images, with interleaved repeats."""
    def steps(given: argparse.Namespace) -> list[Step]:
        (ROOT / runs.PICTURES).mkdir(parents=True, exist_ok=True)
        file = KEPT / f"runs-{name}.json"
        file.write_text(json.dumps([{"section": name, **run} for run in runs.SECTIONS[name](variants(), given.quick)]))
        return [Step(name, "pictures", ("pictures", "--runs", file))]
    return steps


def simulation() -> list[dict]:
    """Returns the simulated units' tests per second, and their instructions if valgrind can count them."""
    done = subprocess.run([ROOT / "build/sim/unit_bench"], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    row = (r"(?P<unit>.+?) +(?P<arithmetic>\S+) +(?P<lanes>\S+) +(?P<hits_percent>[\d.]+) +"
           r"(?P<tests_per_second>\d+)(?: +(?P<instructions>\d+))?$")
    return [{"table": "simulation", **match.groupdict(), "command": "build/sim/unit_bench"}
            for match in re.finditer(row, done.stdout, re.MULTILINE)]


PARTS = {
    **{name: section(name) for name in runs.SECTIONS},
    "simulation": lambda given: [] if given.quick else [Step("simulation", "units", measure=simulation)],
    "synthesis": lambda given: [Step("synthesis", "area and clock", measure=lambda: costs.synthesis(
        variants(), processors(), measure=not given.quick))],
    "energy": lambda given: [Step("energy", "of operations", measure=costs.energies)]}


def judge_pictures(rows: list[dict]) -> list[dict]:
    """Adds FLIP to each image that is compared with another: Andersson et al., "FLIP: a difference evaluator for
    alternating images", 2020, in the authors' implementation (PyPI flip-evaluator), at its default of 67 pixels per
    degree."""
    for row in of(rows, "pictures"):
        if row.get("against"):
            error_map, row["flip"] = plots.flip(*(ROOT / f"{row[key]}.png" for key in ("against", "picture")))
            row["map"] = f"{row['picture']}-flip.png"
            plots.save_pixels(error_map, ROOT / row["map"])
    return rows


def finish(rows: list[dict]) -> list[dict]:
    """Adds the variants and the FLIP of images."""
    return [rows[0], *variants(), *judge_pictures(rows)[1:]]


def frames(rows: list[dict]) -> list[dict]:
    """Returns a copy of each image's row of the section `variants`, with its variant's columns, and

      clocks      per frame: the tests through the unit times the clocks per test of the variant's
                  simulation (of binary32's if it has no hardware: then `clocks_modelled`)
      wrong, doubtful          tests per million
      area, period_ns, frame_ms, area_time    if synthesis has measured the unit
      energy_uj   of the cores, if simulated
    """
    pictures = of(rows, "pictures", section="variants")
    clocks_a_test = {row["variant"]: row["clocks"] / row["unit_tests"] for row in pictures
                     if row["engine"] == "unit" and row["unit_tests"]}
    known = {row["variant"]: row for row in of(rows, "variants")}
    synthesis, energies = of(rows, "synthesis"), of(rows, "energy")
    found = []
    for row in pictures:
        if row["engine"] == "unit" and not row.get("audit"):  # runs of the unit alone, for its clocks
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
    """Returns frames by scene, Pareto plots of the first scene, and images that differ."""
    scenes: dict[str, list] = {}
    for frame in frames(rows):
        scenes.setdefault(frame["scene"], []).append(frame)
    pareto = []
    for error, label in ERRORS.items() if scenes else ():
        scene, mine = next(iter(scenes.items()))
        known = {cost: text for cost, text in COSTS.items() if sum(bool(frame.get(cost)) for frame in mine) > 1}
        pareto.append((plots.pareto(mine, known, error, label, f"{scene}: {label}", folder / f"pareto-{error}.png"), label))
    differences = []
    for scene, mine in scenes.items():
        shown = [(f"{frame['variant']}: FLIP {frame['flip']:.4f}", ROOT / frame["map"])
                 for frame in mine if frame["flip"] >= LEAST_FLIP]
        if shown:
            differences.append((plots.gallery(shown, folder / f"differences-{scene}.png"), scene))
    return {"scenes": scenes, "pareto": pareto, "differences": differences}


def lanes(rows: list[dict], folder: pathlib.Path) -> dict | None:
    """Returns the clocks by number of lanes."""
    mine = of(rows, "pictures", section="lanes", variant="binary32")
    if not mine:
        return None
    serial = of(rows, "pictures", section="lanes", variant="serial")
    return {"row": mine[0], "rows": [*({**row, "unit": "pipelined"} for row in mine), *({**row, "unit": "the paper's"} for row in serial)]}


def values(rows: list[dict], folder: pathlib.Path) -> dict:
    """Returns the report's tables and plots."""
    return {**by_scene(rows, folder), "lanes": lanes(rows, folder)}
