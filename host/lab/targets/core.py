"""`make bench ONLY=core`: clocks of the simulated ray core by scene, kind of ray, memory, and number of cores."""

import argparse
import pathlib
from collections.abc import Callable

from host.lab.rows import grouped, of
from host.lab.steps import Step

FEW = ("scenes/cornell.obj", "scenes/teapot.obj", "build/scenes/sphereflake.obj")
ALL = ("scenes/cornell.obj", "scenes/paper.obj", "scenes/teapot.obj",
       *(f"build/scenes/{name}.obj" for name in ("cornell_spheres", "still_life", "columns", "sphereflake")))


def part(name: str, scenes: tuple, *words: object, every: int = 1) -> Callable[[argparse.Namespace], list[Step]]:
    """Returns a function that makes the steps of a part: a run of `lab core` for each scene, with one of `every` rays."""
    def steps(given: argparse.Namespace) -> list[Step]:
        return [Step(name, f"{name} {scene}", ("core", scene, *words, "--every", 64 if given.quick else every))
                for scene in (FEW[:1] if given.quick else scenes)]
    return steps


PARTS = {"scenes": part("scenes", ALL),
         "exact": lambda given: [step for way in ((), ("--exact",)) for step in part(
             "exact", ALL, "--kinds", "whitted", "path", "--latency", 50, *way)(given)],
         "cores": part("cores", FEW, "--kinds", "camera", "scattered", "--latency", 50, "--cores", 1, 2, 4, 8, every=2)}


def values(rows: list[dict], _: pathlib.Path) -> dict:
    """Returns tables by latency and by number of cores."""
    scenes, cores, exact = (of(rows, "core", part=name) for name in ("scenes", "cores", "exact"))
    latencies = sorted({row["latency"] for row in scenes})
    return {"latencies": latencies, "middle": latencies[len(latencies) // 2] if latencies else None,
            "scenes": grouped(scenes, ("scene", "rays"), "latency"), "exact": grouped(exact, ("scene", "rays"), "exact"),
            "cores": grouped(cores, ("scene", "rays"), "cores"), "numbers": sorted({row["cores"] for row in cores})}
