"""`make peers`: compares raygate with Mitsuba 3: time, error, and their product."""

import argparse
import math
import pathlib

from host.lab.machine import processors
from host.lab.peers.measure import BEST, COUNT, NO_LIGHT_PATHS, SCENES, VARIANTS
from host.lab.report import plots
from host.lab.rows import of
from host.lab.steps import Step


def scenes_of(given: argparse.Namespace, usual: tuple[str, ...], known: tuple[str, ...] = tuple(SCENES)) -> list[str]:
    """Returns the requested scenes, or all; for a quick run the usual ones."""
    unknown = set(given.scenes.split()) - set(known)
    if unknown:
        raise ValueError(f"{', '.join(sorted(unknown))}: expected {', '.join(known)}")
    return given.scenes.split() or list(usual if given.quick else known)


def pictures_steps(given: argparse.Namespace) -> list[Step]:
    """Returns steps that render each scene with both renderers."""
    from host.lab.peers import measure

    return [Step("pictures", scene, measure=lambda scene=scene: measure.measure(
        scene, given.quick, given.render, {1, processors()})) for scene in scenes_of(given, ("cornell", "cornell_spheres"))]


PARTS = {"pictures": pictures_steps}


def name(row: dict) -> str:
    """Returns the name of a renderer and its sampler."""
    if row["renderer"] == "raygate":
        return f"raygate, {row['sampler'].split(' ')[0]}" if row["sampler"].startswith("--") else "raygate"
    return f"{row['renderer']}, {row['sampler']}"


def at_count(rows: list[dict]) -> list[dict]:
    """Returns the rows with about COUNT samples."""
    return [row for row in rows if COUNT / 2 < row["samples"] < 2 * COUNT and name(row) != "raygate, --error"]


def beside_ours(rows: list[dict]) -> list[dict]:
    """Returns rows by renderer, sampler and number of threads, with raygate's row for as many threads."""
    mine = at_count(rows)
    ours = {row["threads"]: row for row in mine if row["renderer"] == "raygate"}
    return [{**row, "by": name(row), "ours": ours[row["threads"]], "pixels": row["width"] * row["height"]} for row in mine]


def ratio(ours: dict, theirs: dict, key: str, *, with_time: bool = True) -> str:
    """Returns raygate's error relative to the other's, optionally times the ratio of times, and its standard error
    over seeds."""
    value = ours[key] / theirs[key] * (ours["median_seconds"] / theirs["median_seconds"] if with_time else 1.0)
    relative = math.hypot(ours[f"{key}_error"] / ours[key], theirs[f"{key}_error"] / theirs[key])
    return f"{value:.2f} ± {value * relative:.2f}"


def summary(rows: list[dict], variant: str) -> list[dict]:
    """Compares raygate with the best sampler of one Mitsuba by each error measure; one thread, equal numbers of
    samples."""
    found = []
    for reference in of(rows, "references"):
        mine = at_count(of(rows, "peers", scene=reference["scene"], threads=1))
        ours = {row["sampler"]: row for row in mine if row["renderer"] == "raygate"}
        (usual,) = (row for sampler, row in ours.items() if not sampler.startswith("--"))
        theirs = [row for row in mine if row["renderer"] == f"Mitsuba {variant}"]
        linear, shown = (min(theirs, key=lambda row, key=key: row["median_seconds"] * row[key]) for key in ("mse", "display_mse"))
        plain = ours.get(NO_LIGHT_PATHS, usual)
        found.append({"scene": reference["scene"], "seconds": usual["median_seconds"] / linear["median_seconds"],
                      "mse": ratio(usual, linear, "mse", with_time=False), "shown": ratio(usual, shown, "display_mse", with_time=False),
                      "time_mse": ratio(usual, linear, "mse"), "time_shown": ratio(usual, shown, "display_mse"),
                      "plain_time_mse": ratio(plain, linear, "mse"), "plain_time_shown": ratio(plain, shown, "display_mse")})
    return found


def error_against_time(rows: list[dict], scene: str, file: pathlib.Path) -> pathlib.Path:
    """Plots error against time for one thread: a line for renderers and samplers with several sample counts, otherwise
    a point."""
    series: dict[str, list] = {}
    mine = of(rows, "peers", scene=scene, threads=1)
    for row in mine:
        if row["renderer"] == "raygate" or row["sampler"] in BEST or row in at_count(mine):
            series.setdefault(name(row), []).append((row["median_seconds"], row["display_rmse"]))
    return plots.lines(series, "seconds, one thread", "RMSE on a display, 8-bit steps", scene, file)


def values(rows: list[dict], folder: pathlib.Path) -> dict:
    """Returns tables by scene, and plots."""
    beyond = max(((max(row["rmse"] ** 2 - row["noise"] ** 2, 0.0)) ** 0.5 for row in of(rows, "references")), default=0.0)
    return {"variants": VARIANTS, "beyond": beyond, "summaries": [(variant, summary(rows, variant)) for variant in VARIANTS],
            "scenes": [{"reference": reference,
                    "rows": beside_ours(of(rows, "peers", scene=reference["scene"])),
                    "plot": error_against_time(rows, reference["scene"], folder / f"peers-{reference['scene']}.png")}
                   for reference in of(rows, "references")]}
