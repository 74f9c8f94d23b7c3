"""`make peers`: compares raygate with Mitsuba 3: time, error, and their product."""

import argparse
import math
import pathlib

from host.lab.peers.measure import CURVES, SCENES, at_count, best, equal_time_samples, measure
from host.lab.report import plots
from host.lab.rows import of, processors
from host.lab.steps import Step


def pictures_steps(given: argparse.Namespace) -> list[Step]:
    """Returns steps that render each scene with both renderers."""
    scenes = given.scenes.split() or SCENES[:2 if given.quick else None]
    if unknown := set(scenes) - set(SCENES):
        raise ValueError(f"{', '.join(sorted(unknown))}: expected {', '.join(SCENES)}")
    return [Step("pictures", scene, measure=lambda scene=scene: measure(scene, given.quick, {1, processors()})) for scene in scenes]


PARTS = {"pictures": pictures_steps}


def name(row: dict) -> str:
    """Returns the name of a renderer and its sampler."""
    return row["renderer"] + ("" if row["renderer"] == "raygate" and not row["sampler"].startswith("--") else f", {row['sampler']}")


def ratio(ours: dict, theirs: dict, error: str) -> str:
    """Returns raygate's error divided by the other renderer's, with the standard error of this ratio over seeds."""
    value, relative = ours[error] / theirs[error], math.hypot(*(row[f"{error}_error"] / row[error] for row in (ours, theirs)))
    return f"{value:.2f} ± {value * relative:.2f}"


def summary(rows: list[dict]) -> list[dict]:
    """Compares raygate with Mitsuba's best sampler for each error, with one thread: at equal samples, and at equal time with and without
    light paths. `off` is the largest relative difference of times that should be equal."""
    found = []
    for reference in of(rows, "references"):
        mine = of(rows, "peers", scene=reference["scene"], threads=1)
        usual, plain = (row for row in at_count(mine) if row["renderer"] == "raygate")
        made = {"scene": reference["scene"], "seconds": usual["median_seconds"] / best(mine, "mse")["median_seconds"], "off": 0.0}
        for error in ("mse", "display_mse"):
            theirs = best(mine, error)
            made[error] = ratio(usual, theirs, error)
            for kind, row in (("equal", usual), ("plain", plain)):
                (equal,) = (other for other in mine if other.get("equal_time") and other["sampler"] == row["sampler"]
                            and other["samples"] == equal_time_samples(row, theirs))
                made[f"{kind}_{error}"] = ratio(equal, theirs, error)
                made["off"] = max(made["off"], abs(equal["median_seconds"] / theirs["median_seconds"] - 1.0))
        found.append(made)
    return found


def error_against_time(rows: list[dict], scene: str, file: pathlib.Path) -> pathlib.Path:
    """Plots error against time for one thread: a line for each renderer and sampler with several sample counts, otherwise a point."""
    series: dict[str, list] = {}
    mine = of(rows, "peers", scene=scene, threads=1)
    for row in mine:
        if not row.get("equal_time") and (row["renderer"] == "raygate" or row["sampler"] in CURVES or row in at_count(mine)):
            series.setdefault(name(row), []).append((row["median_seconds"], row["display_mse"] ** 0.5))
    return plots.lines(series, "seconds, one thread", "RMSE on a display, 8-bit steps", scene, file)


def values(rows: list[dict], folder: pathlib.Path) -> dict:
    """Returns tables by scene, and plots."""
    beyond = max(((max(row["rmse"] ** 2 - row["noise"] ** 2, 0.0) ** 0.5, row["scene"]) for row in of(rows, "references")), default=None)
    compared, mine = summary(rows), of(rows, "peers")
    return {"beyond": beyond, "summary": compared, "off": max((row["off"] for row in compared), default=0.0),
            "each_row": [row | {"by": name(row)} for row in mine if row.get("equal_time") or row in at_count(mine)],
            "plots": [error_against_time(rows, row["scene"], folder / f"peers-{row['scene']}.png") for row in compared]}


PAGE = """# Pictures next to Mitsuba 3

raygate is compiled by {{ machine.compiler }}; Mitsuba 3 is PyPI's, with Debian's libllvm19.
{% if summary %}

Both renderers get the same scene (`host/lab/peers/convert.py`), film and box filter, and integrator `path` with
at most 64 reflections and refractions in a row and Russian roulette after three surfaces. Seconds are medians
of ten interleaved seeds, without loading and compiling; with one thread, they are processor time. Errors are relative
to the renderer's own long run. MSE is the mean square error of scene-linear light, dominated by a few bright pixels;
MSE on a display is that of 8-bit display values.

The algorithms differ. raygate finds caustics by light paths; the last two columns are without them. In scenes without caustics, they differ from the two before by noise in the times, which changes numbers of samples; raygate's sampler is best at powers of two. It traces eight
more rays per sample in pixels with an edge of an emitter. Materials are those that both renderers have. The first five
scenes are raygate's. The last four have models from Debian: `cornell_embree` is Embree's, with its camera, light and
colours; `bunny` (glmark2), `mug` (MuJoCo) and `wuson` (Assimp) are grey, with camera and light chosen here.

Ratios of raygate to Mitsuba (`llvm_ad_rgb`) with its best sampler, which has the least product of time and error, one
thread (mean and standard error of ten seeds); below 1, raygate is better. The first columns are for 32 samples per pixel,
which samplers of Mitsuba round up to as many as {{ each_row|selectattr("renderer", "equalto", "Mitsuba")|map(attribute="samples")|max }}; at equal time, raygate has the samples that fit into Mitsuba's time
(actual times differ by at most {{ "%.0f"|format(100 * off) }} %):

{{ table(summary, "scene", "seconds :.2f", "MSE = mse", "MSE on a display = display_mse", "MSE at equal time = equal_mse", "on a display = equal_display_mse",
         "without light paths = plain_mse", "on a display = plain_display_mse") }}

## Do they compute the same picture?

{{ saved("peers-references", of("references"), "scene", "samples :d", "mean, raygate = mean_raygate :.5f", "mean, Mitsuba = mean_mitsuba :.5f", "RMSE = rmse :.6f", "of which noise = noise :.6f") }}: means of both pictures, the RMSE between them, and the RMSE to expect
from noise. The largest RMSE beyond noise is {{ "%.6f"|format(beyond[0]) }} ({{ beyond[1] }}). `build/peers/SCENE/difference.png` shows ten times the difference, around grey: smooth surfaces differ at silhouettes.

## Error against time

{{ saved("peers-samplers", each_row, "scene", "threads :d", "renderer, sampler = by", "samples :d", "seconds = median_seconds :.3f",
         "million samples/s = 1e-6 * pixels * samples / median_seconds :.2f", "RMSE = mse ** 0.5 :.5f", "RMSE on a display = display_mse ** 0.5 :.3f",
         "time x MSE, 1e-6 = 1e6 * median_seconds * mse :.2f") }}: all samplers with one thread, those with curves also with all threads.

{% for plot in plots %}
![{{ plot.stem }}]({{ plot.name }})
{% endfor %}
{% endif %}
"""
