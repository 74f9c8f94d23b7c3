"""`make peers`: compares raygate with Mitsuba 3: time, error, and their product."""

import argparse
import math
import pathlib

from host.lab.peers.measure import BEST, COUNT, NO_LIGHT_PATHS, SCENES, measure
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
    if row["renderer"] == "raygate":
        return f"raygate, {row['sampler']}" if row["sampler"].startswith("--") else "raygate"
    return f"{row['renderer']}, {row['sampler']}"


def at_count(rows: list[dict]) -> list[dict]:
    """Returns the rows with about COUNT samples per pixel."""
    return [row for row in rows if COUNT / 2 < row["samples"] < 2 * COUNT]


def beside_ours(rows: list[dict]) -> list[dict]:
    """Returns the rows with about COUNT samples per pixel; each has `ours`, raygate's row for the same number of threads."""
    mine = at_count(rows)
    ours = {row["threads"]: row for row in mine if row["renderer"] == "raygate"}
    return [{**row, "by": name(row), "ours": ours[row["threads"]]} for row in mine]


def ratio(ours: dict, theirs: dict, key: str, *, with_time: bool = True) -> str:
    """Returns raygate's error divided by the other renderer's, with the standard error of this ratio over seeds. `with_time` multiplies
    by the ratio of times."""
    value = ours[key] / theirs[key] * (ours["median_seconds"] / theirs["median_seconds"] if with_time else 1.0)
    relative = math.hypot(ours[f"{key}_error"] / ours[key], theirs[f"{key}_error"] / theirs[key])
    return f"{value:.2f} ± {value * relative:.2f}"


def summary(rows: list[dict]) -> list[dict]:
    """Compares raygate with Mitsuba's best sampler for each error measure, with one thread and equal numbers of samples."""
    found = []
    for reference in of(rows, "references"):
        mine = at_count(of(rows, "peers", scene=reference["scene"], threads=1))
        ours = {row["sampler"]: row for row in mine if row["renderer"] == "raygate"}
        (usual,) = (row for sampler, row in ours.items() if not sampler.startswith("--"))
        theirs = [row for row in mine if row["renderer"] == "Mitsuba"]
        linear, shown = (min(theirs, key=lambda row, key=key: row["median_seconds"] * row[key]) for key in ("mse", "display_mse"))
        plain = ours.get(NO_LIGHT_PATHS, usual)
        found.append({"scene": reference["scene"], "seconds": usual["median_seconds"] / linear["median_seconds"],
                      "mse": ratio(usual, linear, "mse", with_time=False), "shown": ratio(usual, shown, "display_mse", with_time=False),
                      "time_mse": ratio(usual, linear, "mse"), "time_shown": ratio(usual, shown, "display_mse"),
                      "plain_time_mse": ratio(plain, linear, "mse"), "plain_time_shown": ratio(plain, shown, "display_mse")})
    return found


def error_against_time(rows: list[dict], scene: str, file: pathlib.Path) -> pathlib.Path:
    """Plots error against time for one thread: a line for each renderer and sampler with several sample counts, otherwise a point."""
    series: dict[str, list] = {}
    mine = of(rows, "peers", scene=scene, threads=1)
    for row in mine:
        if row["renderer"] == "raygate" or row["sampler"] in BEST or row in at_count(mine):
            series.setdefault(name(row), []).append((row["median_seconds"], row["display_rmse"]))
    return plots.lines(series, "seconds, one thread", "RMSE on a display, 8-bit steps", scene, file)


def values(rows: list[dict], folder: pathlib.Path) -> dict:
    """Returns tables by scene, and plots."""
    beyond = max(((max(row["rmse"] ** 2 - row["noise"] ** 2, 0.0)) ** 0.5 for row in of(rows, "references")), default=0.0)
    return {"beyond": beyond, "summary": summary(rows),
            "scenes": [{"reference": reference,
                    "rows": beside_ours(of(rows, "peers", scene=reference["scene"])),
                    "plot": error_against_time(rows, reference["scene"], folder / f"peers-{reference['scene']}.png")}
                   for reference in of(rows, "references")]}


PAGE = """# Pictures next to Mitsuba 3

raygate is compiled by {{ machine.compiler }}; Mitsuba 3 is PyPI's, with Debian's libllvm19.
{% if scenes %}

Both renderers get the same scene (`host/lab/peers/convert.py`), film and box filter, and integrator `path` with
at most 64 reflections and refractions in a row and Russian roulette after three surfaces. Seconds are medians
of ten interleaved seeds, without loading and compiling; with one thread, they are processor time. Errors are relative
to the renderer's own long run. MSE is the mean square error of scene-linear light, dominated by a few bright pixels;
MSE on a display is that of 8-bit display values.

The algorithms differ. raygate finds caustics by light paths; the last two columns are
without them. It traces eight more rays per sample in pixels with an edge of an emitter. All
scenes are raygate's, with materials that both renderers have.

Ratios of raygate to Mitsuba (`llvm_ad_rgb`) with its best sampler, one thread, 32 samples per pixel (mean ± standard error of ten seeds); below 1, raygate is better:

{{ table(summary, "scene", "seconds :.2f", "MSE = mse", "MSE on a display = shown", "time x MSE = time_mse", "time x MSE on a display = time_shown",
         "time x MSE without light paths = plain_time_mse", "on a display = plain_time_shown") }}

## Do they compute the same picture?

{{ saved("peers-references", of("references"), "scene", "samples :d", "mean, raygate = mean_raygate :.5f", "mean, Mitsuba = mean_mitsuba :.5f", "RMSE = rmse :.6f", "of which noise = noise :.6f") }}: means of both pictures, the RMSE between them, and the RMSE to expect
from noise. The largest RMSE beyond noise is {{ "%.6f"|format(beyond) }}.

## Error against time

{% set each_row = scenes|map(attribute="rows")|sum(start=[]) %}
{{ saved("peers-samplers", each_row, "scene", "threads :d", "renderer, sampler = by", "samples :d", "seconds = median_seconds :.3f",
         "million samples/s = 1e-6 * pixels * samples / median_seconds :.2f",
         "RMSE = mse ** 0.5 :.5f", "RMSE on a display = display_rmse :.3f",
         "time x MSE, 1e-6 = 1e6 * time_mse :.2f", "over raygate's = time_mse / ours.time_mse :.2f") }}: all samplers, with one thread and with all.

{% for scene in scenes %}
![{{ scene.plot.stem }}]({{ scene.plot.name }})
{% endfor %}
{% endif %}
"""
