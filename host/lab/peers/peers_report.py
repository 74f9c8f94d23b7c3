"""The tables and plots of `make peers`, for peers.md.j2."""

import pathlib

from host.lab.report import plots, rows as kept
from host.lab.report.document import render, table
from host.lab.peers.measure import BEST, COUNT, VARIANTS


def name(row: dict) -> str:
    """Who rendered, and how."""
    if row["renderer"] == "raygate":
        return "raygate, --error" if row["sampler"].startswith("--error") else "raygate"
    return f"{row['renderer']}, {row['sampler']}"


def at_count(rows: list[dict]) -> list[dict]:
    """Those of about COUNT samples."""
    return [row for row in rows if COUNT / 2 < row["samples"] < 2 * COUNT and name(row) != "raygate, --error"]


def scene_table(rows: list[dict]) -> str:
    """A line for each renderer, sampler and number of threads."""
    cells = []
    for row in at_count(rows):
        ours = next(other for other in at_count(rows)
                    if other["renderer"] == "raygate" and other["threads"] == row["threads"])
        pixels = row["width"] * row["height"]
        rays = ours["rays"] / ours["samples"] * row["samples"]
        cells.append([row["threads"], name(row), row["samples"], row["median_seconds"],
                      1e-6 * pixels * row["samples"] / row["median_seconds"], 1e-6 * rays / row["median_seconds"],
                      row["mse"] ** 0.5, 1e6 * row["time_mse"], row["time_mse"] / ours["time_mse"]])
    return table({"threads": "d", "renderer, sampler": "", "samples": "d", "seconds": ".3f",
                  "million samples/s": ".2f", "million rays/s": ".2f", "RMSE": ".5f", "time x MSE, 1e-6": ".2f",
                  "over raygate's": ".2f"}, cells)


def references_table(rows: list[dict]) -> str:
    """Do the pictures agree?"""
    return table({"scene": "", "samples": ",", "mean, raygate": ".5f", "mean, Mitsuba": ".5f",
                  "RMSE between them": ".6f", "of which noise": ".6f"},
                 [[row["scene"], row["samples"], row["mean_raygate"], row["mean_mitsuba"], row["rmse"], row["noise"]]
                  for row in kept.of(rows, "references")])


def summary_table(rows: list[dict]) -> str:
    """raygate's product of time and MSE over that of each Mitsuba's best sampler, one thread: below 1 is better."""
    cells = []
    for reference in kept.of(rows, "references"):
        mine = at_count(kept.of(rows, "peers", scene=reference["scene"], threads=1))
        (ours,) = (row for row in mine if row["renderer"] == "raygate")
        ratios = [ours["time_mse"] / min(row["time_mse"] for row in mine if row["renderer"] == f"Mitsuba {variant}")
                  for variant in VARIANTS]
        cells.append([reference["scene"], ours["median_seconds"], ours["mse"] ** 0.5, *ratios])
    return table({"scene": "", "seconds": ".3f", "RMSE": ".5f",
                  **{f"time x MSE over {variant}'s": ".2f" for variant in VARIANTS}}, cells)


def tables(rows: list[dict]) -> str:
    """Everything, to be printed."""
    parts = [references_table(rows), summary_table(rows)]
    for reference in kept.of(rows, "references"):
        parts += [reference["scene"], scene_table(kept.of(rows, "peers", scene=reference["scene"]))]
    return "\n".join(parts)


def error_against_time(rows: list[dict], scene: str, file: pathlib.Path) -> pathlib.Path:
    """Of one thread: a line for each renderer and sampler of several numbers of samples, a point for the others."""
    series: dict[str, list] = {}
    mine = kept.of(rows, "peers", scene=scene, threads=1)
    for row in mine:
        if row["renderer"] == "raygate" or row["sampler"] in BEST or row in at_count(mine):
            series.setdefault(name(row), []).append((row["median_seconds"], row["display_rmse"]))
    plot, _ = plots.scaling(series, "seconds, one thread", "RMSE on a display, 8-bit steps", scene, file)
    return plot


def build(rows: list[dict], folder: pathlib.Path) -> str:
    """The report, its plots in `folder`."""
    scenes = []
    for reference in kept.of(rows, "references"):
        mine = kept.of(rows, "peers", scene=reference["scene"])
        plot = error_against_time(mine, reference["scene"], folder / f"peers-{reference['scene']}.png")
        scenes.append({"reference": reference, "table": scene_table(mine), "plot": plot})
    return render("peers.md.j2", folder, machine=kept.of(rows, "machine")[0], references=references_table(rows),
                  summary=summary_table(rows),
                  scenes=scenes)
