"""`make core`: clocks of the simulated ray core by scene, kind of ray, memory, rays in flight and cores."""

import argparse
import pathlib
from collections.abc import Callable

from matplotlib import ticker

from host.lab.report import plots
from host.lab.rows import grouped, of
from host.lab.steps import Step

FEW = ("scenes/cornell.obj", "scenes/teapot.obj", "build/scenes/sphereflake.obj")
ALL = ("scenes/cornell.obj", "scenes/paper.obj", "scenes/teapot.obj",
       *(f"build/scenes/{name}.obj" for name in ("cornell_spheres", "still_life", "columns", "sphereflake")))
SCATTERED = ("--kinds", "camera", "scattered")
PICTURES = ("--kinds", "whitted", "path", "--latency", 50)


def part(name: str, scenes: tuple, *words: object, every: int = 1) -> Callable[[argparse.Namespace], list[Step]]:
    """Returns a function that makes the steps of a part: a run of `lab core` for each scene, with one of `every` rays."""
    def steps(given: argparse.Namespace) -> list[Step]:
        return [Step(name, f"{name} {scene}", ("core", scene, *words, "--every", 64 if given.quick else every))
                for scene in (FEW[:1] if given.quick else scenes)]
    return steps


PARTS = {"scenes": part("scenes", ALL),
         "wide": part("wide", ALL, "--latency", 200, "--in-flight", 128),
         "in-flight": part("in-flight", FEW, *SCATTERED, "--in-flight", *(2 ** power for power in range(9)), every=4),
         "exact": lambda given: [step for way in ((), ("--exact",)) for step in part("exact", ALL, *PICTURES, *way)(given)],
         "cores": part("cores", FEW, *SCATTERED, "--latency", 50, "--cores", 1, 2, 4, 8, every=2)}


def draw(rows: list[dict], file: pathlib.Path) -> pathlib.Path:
    """Plots clocks per ray against rays in flight: a panel for each scene and kind of ray, a line for each latency."""
    panels = list(dict.fromkeys((row["scene"], row["rays"]) for row in rows))
    figure, grid = plots.panels(len(panels), 3, (4.2, 3.6), sharex=True)
    for axes, (scene, kind) in zip(grid, panels, strict=True):
        for latency in sorted({row["latency"] for row in rows}):
            points = of(rows, "core", scene=scene, rays=kind, latency=latency)
            axes.plot([row["in_flight"] for row in points], [row["clocks_per_ray"] for row in points], marker="o",
                      markersize=4, label=f"memory {latency} clock{'s' * (latency > 1)} away")
        axes.set(title=f"{scene}, {kind} rays", xscale="log", yscale="log")
        axes.xaxis.set_major_locator(ticker.LogLocator(base=2, numticks=10))
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(ticker.StrMethodFormatter("{x:g}"))
        axes.yaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        axes.xaxis.set_minor_locator(ticker.NullLocator())
        axes.yaxis.set_minor_locator(ticker.NullLocator())
        axes.grid(alpha=0.3)
    grid[0].legend(fontsize=8)
    figure.supxlabel("rays in flight")
    figure.supylabel("clocks a ray")
    return plots.save(figure, file)


def values(rows: list[dict], folder: pathlib.Path) -> dict:
    """Returns tables by latency and by number of cores, and the plot."""
    scenes, cores, wide, exact = (of(rows, "core", part=name) for name in ("scenes", "cores", "wide", "exact"))
    latencies = sorted({row["latency"] for row in scenes})
    by_latency = grouped(scenes, ("scene", "rays"), "latency")
    usual = {(row["scene"], row["rays"]): row["at"] for row in by_latency}
    in_flight = of(rows, "core", part="in-flight")
    return {"latencies": latencies, "middle": latencies[len(latencies) // 2] if latencies else None,
            "scenes": by_latency, "wide": [{**row, "at": usual.get((row["scene"], row["rays"]), {})} for row in wide],
            "exact": grouped(exact, ("scene", "rays"), "exact"),
            "cores": grouped(cores, ("scene", "rays"), "cores"), "numbers": sorted({row["cores"] for row in cores}),
            "plot": draw(in_flight, folder / "core.png") if in_flight else None}
