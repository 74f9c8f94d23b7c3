"""`make bench`: run time against error, by variant of arithmetic, engine and number of lanes."""

import argparse
import functools
import pathlib
import statistics
import subprocess
import sys

from host.lab.bench import costs
from host.lab.machine import processors
from host.lab.report import plots
from host.lab.rows import KEPT, ROOT, of, read, scene_name
from host.lab.steps import LAB, Step, render

PICTURES = "build/bench/pictures"
# Scenes of the variants' pictures: integrator, and samples per pixel.
SCENES = {"cornell": ("path", 4), "paper": ("whitted", 1), "teapot": ("primary", 1)}
ENGINES = ("scenes/cornell.obj", "scenes/paper.obj", "scenes/teapot.obj", "build/scenes/sphere.obj", "build/scenes/sphereflake.obj")
# Units and the engines that compute them.
WAYS = (("pipeline", "cpu"), ("pipeline", "rtl"), ("serial", "model"), ("serial", "rtl"))
# Costs on the axes of the Pareto plots: key of a frame, label.
COSTS = {"clocks": "clocks per frame", "frame_ms": "ms per frame at the clock of synthesis",
         "area": "area, um2 in OSU 0.35 um", "area_time": "area x ms per frame"}
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


def variants_steps(given: argparse.Namespace) -> list[Step]:
    """Returns steps that render each scene in all variants; the first one also by the hardware, for its clocks."""
    size = ("--width", 160, "--height", 120) if given.quick else ()
    return [Step("variants", scene, ("pictures", f"scenes/{scene}.obj", f"{PICTURES}/{scene}", *size, "--integrator", integrator,
                                     "--samples", 1 if given.quick else samples, *(("--clocks",) if scene == "cornell" else ())))
            for scene, (integrator, samples) in SCENES.items()]


def timed(table: str, scene: str, ways: list[dict], repeats: int, *words: str) -> list[dict]:
    """Returns a row for each way of rendering, options by name: medians of the processor seconds of interleaved repeats."""
    runs = [[render([ROOT / "render", scene], "--threads", "1", *words, *(word for name, value in way.items() for word in (f"--{name}", str(value))))
             for way in ways] for _ in range(repeats)]
    found = []
    for way, mine in zip(ways, zip(*runs), strict=True):
        seconds = [run["seconds"]["processor"] for run in mine]
        middle = statistics.median(seconds)
        found.append({"table": table, "scene": scene, "lanes": 1, **{key: mine[0][key] for key in ("triangles", "rays", "tests", "unit_tests", "clocks")},
                      "seconds": middle, "spread_percent": 100 * statistics.median(abs(one - middle) for one in seconds) / middle, **way})
    return found


def engines_steps(given: argparse.Namespace) -> list[Step]:
    """Returns steps that time the renderer's engines and units."""
    size, scenes, repeats = ("96x72", ENGINES[:3], 3) if given.quick else ("320x200", ENGINES, 9)
    ways = [{"unit": unit, "engine": engine} for unit, engine in WAYS]
    return [Step("engines", scene, measure=lambda scene=scene: timed(
        "engines", scene, ways, repeats, "--integrator", "primary", "--spp", "1", "--size", size)) for scene in scenes]


def lanes_steps(given: argparse.Namespace) -> list[Step]:
    """Returns the step that renders the paper's scene, with shadows and reflections, on 1 to 8 lanes and on its unit."""
    ways = [*({"engine": "rtl", "unit": "pipeline", "lanes": count} for count in (1, 2, 4, 8)), {"engine": "rtl", "unit": "serial"}]
    return [Step("lanes", "the paper's scene", measure=lambda: timed(
        "lanes", "scenes/paper.obj", ways, 1 if given.quick else 3, "--integrator", "whitted", "--spp", "1", "--size", "320x200"))]


PARTS = {"variants": variants_steps, "engines": engines_steps, "lanes": lanes_steps,
         "synthesis": lambda given: [Step("synthesis", "area and clock", measure=lambda: costs.synthesis(
             variants(), processors(), measure=not given.quick))]}


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
    """Returns a copy of each picture's row, with its variant's columns, and

      clocks      per frame: the tests through the unit times the clocks per test of the variant's
                  simulation (of binary32's if it has no hardware: then `clocks_modelled`)
      wrong, doubtful          tests per million
      area, period_ns, frame_ms, area_time    if synthesis has measured the unit
    """
    pictures = of(rows, "pictures")
    clocks_a_test = {row["variant"]: row["clocks"] / row["unit_tests"] for row in pictures
                     if row["engine"] == "unit" and row["unit_tests"]}
    known = {row["variant"]: row for row in of(rows, "variants")}
    synthesis = of(rows, "synthesis")
    found = []
    for row in pictures:
        if "decisions" not in row:  # by the unit, for its clocks
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
        record = costs.unit(synthesis, variant)
        if record:
            frame |= {"area": record["area"], "period_ns": record["delay_ns"], "wired_ns": record.get("wired_ns"),
                      "frame_ms": frame["clocks"] * record["delay_ns"] * 1e-6}
            frame["area_time"] = frame["area"] * frame["frame_ms"]
        found.append(frame)
    return found


def values(rows: list[dict], folder: pathlib.Path) -> dict:
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
