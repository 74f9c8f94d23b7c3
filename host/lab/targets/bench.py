"""`make bench`: run time against error, by variant of arithmetic, engine and number of lanes."""

import argparse
import functools
import pathlib
import statistics

from host.lab.report import plots
from host.lab.rows import ROOT, grouped, of, processors, scene_name
from host.lab.steps import Step, render, run_lab
from host.lab.targets import costs

PICTURES = "build/bench/pictures"
# Scenes of the variants' pictures: integrator, and samples per pixel.
SCENES = {"cornell": ("path", 4), "paper": ("whitted", 1), "teapot": ("primary", 1)}
ENGINES = ("scenes/cornell.obj", "scenes/paper.obj", "scenes/teapot.obj", "build/scenes/sphere.obj", "build/scenes/sphereflake.obj")
# Pairs of a unit and an engine.
WAYS = (("pipeline", "cpu"), ("pipeline", "rtl"), ("serial", "model"), ("serial", "rtl"))
# Series of the plot: unit, and whether doubts are resolved.
KINDS = {("pipeline", True): "pipelined unit, doubts resolved", ("pipeline", False): "pipelined unit, doubts ignored",
         ("serial", True): "the paper's unit, software decides"}


@functools.cache
def variants() -> list[dict]:
    """Returns the rows of `lab variants`."""
    return run_lab("variants")


def variants_steps(given: argparse.Namespace) -> list[Step]:
    """Returns steps that render each scene in all variants, and cornell also by the hardware, to count clocks."""
    size = ("--width", 160, "--height", 120) if given.quick else ()
    return [Step("variants", scene, ("pictures", f"scenes/{scene}.obj", f"{PICTURES}/{scene}", *size, "--integrator", integrator,
                                     "--samples", 1 if given.quick else samples, *(("--clocks",) if scene == "cornell" else ())))
            for scene, (integrator, samples) in SCENES.items()]


def timed(table: str, scene: str, ways: list[dict], repeats: int, *words: str) -> list[dict]:
    """Returns a row for each of `ways` (options by name) with the median processor seconds of interleaved repeats."""
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
    """Returns the step that renders the paper's scene, with shadows and reflections, on 1 to 8 lanes and on the paper's unit."""
    ways = [*({"engine": "rtl", "unit": "pipeline", "lanes": count} for count in (1, 2, 4, 8)), {"engine": "rtl", "unit": "serial"}]
    return [Step("lanes", "the paper's scene", measure=lambda: timed(
        "lanes", "scenes/paper.obj", ways, 1 if given.quick else 3, "--integrator", "whitted", "--spp", "1", "--size", "320x200"))]


PARTS = {"variants": variants_steps, "engines": engines_steps, "lanes": lanes_steps,
         "synthesis": lambda given: [Step("synthesis", "area and clock", measure=lambda: costs.synthesis(
             variants(), processors(), measure=not given.quick))]}


def judge_pictures(rows: list[dict]) -> list[dict]:
    """Adds FLIP to the row of each image that is compared with another image. FLIP is by Andersson et al., "FLIP: a difference evaluator
    for alternating images", 2020, in the authors' implementation (PyPI flip-evaluator), at its default of 67 pixels per degree."""
    for row in of(rows, "pictures"):
        if row.get("against"):
            error_map, row["flip"] = plots.flip(*(ROOT / f"{row[key]}.png" for key in ("against", "picture")))
            row["map"] = f"{row['picture']}-flip.png"
            plots.save_pixels(error_map, ROOT / row["map"])
    return rows


def finish(rows: list[dict]) -> list[dict]:
    """Adds the rows of `lab variants` and the FLIP of images."""
    return [rows[0], *variants(), *judge_pictures(rows)[1:]]


def frames(rows: list[dict]) -> list[dict]:
    """Returns a copy of each picture's row, with columns of its variant and

      clocks      per frame: tests through the unit times simulated clocks per test. A variant that was not simulated has
                  `clocks_modelled`, and the clocks per test of variant binary32 or, if in the paper's unit, serial
      wrong, doubtful          tests per million
      area, period_ns, frame_ms, area_time    if synthesis has measured the unit
    """
    pictures = of(rows, "pictures")
    clocks_a_test = {row["variant"]: row["clocks"] / row["unit_tests"] for row in pictures if row["engine"] == "unit" and row["unit_tests"]}
    known = {row["variant"]: row for row in of(rows, "variants")}
    synthesis = of(rows, "synthesis")
    found = []
    for row in pictures:
        if "decisions" not in row:  # rendered by the hardware, to count clocks
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
            frame |= {"area": record["area"], "period_ns": record["delay_ns"], "frame_ms": frame["clocks"] * record["delay_ns"] * 1e-6}
            frame["area_time"] = frame["area"] * frame["frame_ms"]
        found.append(frame)
    return found


def values(rows: list[dict], folder: pathlib.Path) -> dict:
    """Returns frames by scene, and for the first scene a plot of the error of P against time."""
    scenes: dict[str, list] = {}
    for frame in frames(rows):
        scenes.setdefault(frame["scene"], []).append(frame)
    series: dict[str, list] = {}
    for frame in next(iter(scenes.values()), []):
        if frame.get("frame_ms"):
            series.setdefault(KINDS[frame["unit"], frame["doubts"]], []).append((frame["frame_ms"], frame["point"], frame["variant"]))
    return {"scenes": scenes, "plot": plots.lines(
        series, "ms per frame at the clock of synthesis", "error of P, 99th percentile, ulp of binary32", next(iter(scenes)),
        folder / "bench-error.png") if series else None,
        "ways": [f"{unit} {engine}" for unit, engine in WAYS],
        "engines": grouped([row | {"way": f"{row['unit']} {row['engine']}"} for row in of(rows, "engines")], ("scene",), "way")}


PAGE = """# Run time against error, from the adder to the picture

{% if scenes %}

## Arithmetic

{% set first = scenes.values()|first %}
Pictures of {{ first[0].width }} x {{ first[0].height }} pixels, rendered by the reference model of each variant. Variants named raw ignore doubts, the others resolve them.

* **wrong tests**: tests of camera rays decided differently from exact arithmetic. **P**: error in binary32 ulps, of correctly decided rays.
* **FLIP**: mean perceptual difference from binary32's picture; a dash means equal pictures. Variants shade the P that they computed;
non-raw ones only if its error is within `--point-error`.
* **area**, **period**: by `make synth`, OSU 0.35 um, cells alone; variants without these figures are only in the CSV. **clocks** (CSV only):
tests times simulated clocks per test; a star marks variants without hardware, for which binary32's rate is used.

Scene {{ first[0].scene }} ({{ first[0].integrator }}, samples per pixel: {{ first[0].samples }}):

{{ table(first|selectattr("area", "defined")|list or first, "variant", "wrong tests per million = wrong :.0f", "doubts per million = doubtful :.0f", "P, ulp: median = decisions.point_ulp.p50 :.3g",
         "FLIP = flip if differing_pixels :.4f", "area, mm2 = area / 1e6 :.2f", "period, ns = period_ns :.2f") }}
{{ saved("bench-variants", scenes.values()|sum(start=[]), "scene", "integrator", "samples :d", "variant", "bits = '1+%d+%d'|format(exponent_bits, digits - 1)",
         "doubts = 'resolved' if doubts else 'ignored'", "wrong tests per million = wrong :.0f", "doubts per million = doubtful :.0f", "wrong rays = decisions.wrong_rays :d",
         "P, ulp: median = decisions.point_ulp.p50 :.3g", "99 % = decisions.point_ulp.p99 :.3g", "largest = decisions.point_ulp.max :.3g",
         "t, ulp: 99 % = decisions.t_ulp.p99 :.3g", "RMSE = rmse if differing_pixels :.3g", "FLIP = flip if differing_pixels :.4f",
         "clocks = '%.0f'|format(clocks) ~ (' *' if clocks_modelled else '')", "area :d", "period, ns = period_ns :.2f",
         "ms per frame = frame_ms :.3f", "area x ms = area_time :.3g") }}: all scenes ({{ scenes|join(", ") }}), all measures.

{% if plot %}
{{ figure(plot, "Scene %s: error of P against time per frame." % first[0].scene) }}
{% endif %}
{% endif %}
{% if of("engines") %}

## Engines

Rates are of one thread, by the median processor time of interleaved
repeats. The spread is the median distance from that median.

{{ table(engines, "scene = scene_name(row)", "triangles :,", each(ways, "rays/s, {} = at['{}'].rays / at['{}'].seconds :,.0f")) }}
{{ saved("bench-engines", of("engines"), "scene = scene_name(row)", "triangles :d", "unit", "engine",
         "seconds :.4g", "spread, % = spread_percent :.1f", "rays/s = rays / seconds :.0f",
         "tests per ray = tests / rays :.2f", "clocks per test = clocks / unit_tests if clocks :.2f") }} has seconds, spreads, tests and clocks.
{% endif %}
{% if of("lanes") %}

## Lanes

`scenes/paper.obj`, 320 x 200 pixels, with shadows and reflections. For such a picture, the paper counts 5.12 million tests (320 x 200 rays, 20 polygons, 4 reflections) of one
clock each; its unit takes seven. The figures here differ: the paper's scene is unknown, and here rays skip
boxes that they miss. Lane clocks per test are clocks times lanes, divided by tests.

{{ table(of("lanes"), "unit", "lanes :d", "clocks per frame = clocks :,.0f", "lane clocks per test = clocks * lanes / unit_tests :.3f",
         "simulation, s = seconds :.3g") }}
{% endif %}
"""
