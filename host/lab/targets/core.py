"""`make bench ONLY=core`: clocks of the simulated ray core by scene, kind of ray and memory."""

import argparse
import pathlib
from collections.abc import Callable

from host.lab.rows import grouped, of
from host.lab.steps import Step

SCENES = ("scenes/cornell.obj", "scenes/paper.obj", "scenes/teapot.obj",
       *(f"build/scenes/{name}.obj" for name in ("cornell_spheres", "still_life", "columns", "sphereflake")))


def part(name: str, *words: object) -> Callable[[argparse.Namespace], list[Step]]:
    """Returns a function that makes the steps of a part: a run of `lab core` for each scene."""
    return lambda given: [Step(name, f"{name} {scene}", ("core", scene, *words)) for scene in (SCENES[:1] if given.quick else SCENES)]


PARTS = {"scenes": part("scenes"),
         "exact": lambda given: [step for way in ((), ("--exact",)) for step in part(
             "exact", "--kinds", "whitted", "path", "--latency", 50, *way)(given)]}


def values(rows: list[dict], _: pathlib.Path) -> dict:
    """Returns tables by kind of ray and latency."""
    scenes, exact = (of(rows, "core", part=name) for name in ("scenes", "exact"))
    latencies = sorted({row["latency"] for row in scenes})
    middle = latencies[len(latencies) // 2] if latencies else None
    return {"latencies": latencies, "middle": middle, "kinds": list(dict.fromkeys(row["rays"] for row in scenes)),
            "usual": grouped([row for row in scenes if row["latency"] == middle], ("scene",), "rays"),
            "scenes": grouped(scenes, ("scene", "rays"), "latency"), "exact": grouped(exact, ("scene", "rays"), "exact")}


PAGE = """# The ray core in simulation

Clocks of the simulated `hw/ray_core` for 128x128 pixels. Memory delivers one 64-byte line per clock; latency is the
number of clocks from a request to its line. Each answer was compared with the cpu engine's.
{% if scenes %}

## Rays of a picture

Clocks per ray, by kind of ray, at latency {{ middle }}:

{{ table(usual, "scene", each(kinds, "{} = at['{}'].clocks_per_ray :.2f")) }}
{{ saved("core-scenes", scenes, "scene", "rays", each(latencies, "clocks/ray, latency {} = at[{}].clocks_per_ray :.2f"),
         each([middle], "lines/ray = at[{}].lines_per_ray :.2f", "bytes/ray = at[{}].bytes_per_ray :.0f",
              "boxes busy, % = at[{}].nodes_percent :.1f", "triangles busy, % = at[{}].triangles_percent :.1f",
              "doubts/1000 rays = at[{}].doubts_per_1000 :.2f")) }} has all latencies; for latency {{ middle }} also lines, bytes and doubts per ray, and the
percentage of clocks in which `box_unit` and `triangle_test` are busy.
{% endif %}
{% if exact %}

## Doubts settled by the core

These are all rays of a path-traced picture with one sample per pixel, at latency 50. Doubts sent out are resolved by the host, whose time is not counted. Settled doubts are resolved by the core.

{{ table(exact|selectattr("rays", "equalto", "path")|list, "scene", "clocks/ray, doubts sent out = at[False].clocks_per_ray :.2f",
         "settled = at[True].clocks_per_ray :.2f") }}
{{ saved("core-exact", exact, "scene", "rays", "clocks/ray, doubts sent out = at[False].clocks_per_ray :.2f",
         "clocks/ray, settled = at[True].clocks_per_ray :.2f", "doubts/1000 rays = at[True].doubts_per_1000 :.2f",
         "near ties/1000 rays = at[True].near_ties_per_1000 :.2f", "exact unit busy, % = at[True].exact_percent :.2f") }} also has Whitted pictures, doubts per ray, and the percentage
of clocks in which `exact_unit` is busy.
{% endif %}
"""
