"""`make peers`: compares raygate with Mitsuba 3: time, error, and their product."""

import argparse
import pathlib

from host.lab.machine import processors
from host.lab.peers.measure import BEST, COUNT, SCENES, VARIANTS
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
        return "raygate, --error" if row["sampler"].startswith("--error") else "raygate"
    return f"{row['renderer']}, {row['sampler']}"


def at_count(rows: list[dict]) -> list[dict]:
    """Returns the rows with about COUNT samples."""
    return [row for row in rows if COUNT / 2 < row["samples"] < 2 * COUNT and name(row) != "raygate, --error"]


def beside_ours(rows: list[dict]) -> list[dict]:
    """Returns rows by renderer, sampler and number of threads, with raygate's row for as many threads."""
    mine = at_count(rows)
    ours = {row["threads"]: row for row in mine if row["renderer"] == "raygate"}
    return [{**row, "by": name(row), "ours": ours[row["threads"]], "pixels": row["width"] * row["height"]} for row in mine]


def summary(rows: list[dict]) -> list[dict]:
    """Returns raygate's product of time and MSE relative to that of each Mitsuba's best sampler, for one thread: below
    1 is better."""
    found = []
    for reference in of(rows, "references"):
        mine = at_count(of(rows, "peers", scene=reference["scene"], threads=1))
        (ours,) = (row for row in mine if row["renderer"] == "raygate")
        found.append({**ours, "over": {
            variant: ours["time_mse"] / min(row["time_mse"] for row in mine if row["renderer"] == f"Mitsuba {variant}")
            for variant in VARIANTS}})
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
    return {"variants": VARIANTS, "beyond": beyond, "summary": summary(rows),
            "scenes": [{"reference": reference,
                    "rows": beside_ours(of(rows, "peers", scene=reference["scene"])),
                    "plot": error_against_time(rows, reference["scene"], folder / f"peers-{reference['scene']}.png")}
                   for reference in of(rows, "references")]}
