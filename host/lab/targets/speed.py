"""`make speed`: rays per second, compared with Embree's."""

import argparse
import pathlib
import sysconfig

from host.lab.rows import grouped, of
from host.lab.steps import Step

SCENES = ("scenes/cornell.obj", "scenes/teapot.obj", "scenes/paper.obj",
          *(f"build/scenes/{name}.obj" for name in ("sphere", "sphereflake", "landscape")))


def rays_steps(given: argparse.Namespace) -> list[Step]:
    """Returns a step for each scene. Embree 4 is the library in PyPI's package embreex, if that is installed."""
    words = ("--size", 128, "--repeats", 1) if given.quick else ()
    for library in sorted(pathlib.Path(sysconfig.get_path("platlib")).glob("embreex.libs/libembree4*"))[:1]:
        words += ("--embree4", library)
    return [Step("rays", scene, ("rays", scene, *words)) for scene in (SCENES[:1] if given.quick else SCENES)]


PARTS = {"rays": rays_steps}


def over_best(row: dict) -> dict:
    """Returns a row with raygate's rays per second relative to Embree's fastest mode and fastest robust mode, of all versions."""
    found = {**row, "mrays": row["at"]["raygate"]["mrays_per_second"]}
    for kind, ending in (("fast", ""), ("robust", " robust")):
        peers = [peer for name, peer in row["at"].items() if name != "raygate" and name.endswith(ending)]
        best = min(peers, key=lambda peer: peer["raygate_over_peer"])
        low, ratio, high = (best[column] for column in ("lower_quartile", "raygate_over_peer", "upper_quartile"))
        form = ".1f" if high - low >= 0.1 else ".2f"
        found |= {kind: f"{ratio:{form}} ({low:{form}} to {high:{form}})", f"{kind}_mode": best["by"].removesuffix(ending)}
    return found


def values(rows: list[dict], _: pathlib.Path) -> dict:
    """Returns raygate's rays per second relative to Embree's best modes."""
    return {"over_best": [over_best(row) for row in grouped(of(rows, "rays"), ("scene", "rays"), "by")]}


PAGE = """# Rays per second next to Embree's

Columns "over" are raygate's rays per second divided by those of Embree's fastest mode and fastest robust mode; only raygate's decisions
are exact. Each figure is the median of {{ of("rays")[0].repeats }} ratios, each of a run of raygate and the run of Embree after it; their
quartiles are in parentheses. Rates are of one thread, by processor time; compare only rows of one run. Embree3 is Debian's 3.13, Embree4
PyPI's 4.4 (embreex). Modes -1 trace single rays, -8 and -16 packets, -stream 1,024 rays. Embree builds BVHs of high quality and gets the
coherent flag for rays of one origin. For a hit, Embree also computes u, v and the normal, raygate P and an interval that contains t. The
cpu engine uses {{ of("rays")[0].engine_vectors }} vectors (the machine has {{ of("rays")[0].machine_vectors }}), Embree the widest that it supports.

{{ table(over_best, "scene", "rays", "raygate, Mrays/s = mrays :.1f", "over the fastest = fast", "mode = fast_mode",
         "over the fastest robust = robust", "mode = robust_mode") }}
{{ saved("speed-rays", of("rays"), "scene", "rays", "by", "Mrays/s = mrays_per_second :.2f", "raygate over it = raygate_over_peer :.3f",
"lower quartile = lower_quartile :.3f", "upper quartile = upper_quartile :.3f", "agreed, % = agreed_percent :.5f") }} has all modes, and the percentage of rays for which both report the same.
"""
