"""Prints what the paper's frame takes at 10 MHz: clocks, frames a second, and bytes read for its tests.

The paper's frame is scenes/paper.obj at 320 x 200, 4 bounces. The paper tests every ray on every polygon;
so do the first rows, those that follow leave out what culling does. Clocks and bytes are those that `render`
counts in simulation; ~9 lanes are calculated: the tests, evenly shared, with as many idle clocks for each
lane as 8 lanes have. Ray cores walk the tree by themselves. The paper's own figures stand beside them:
5,120,000 clocks on one chip, 18 frames a second on nine.

usage: frame_rates.py RENDER SCENE
"""

import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile

CLOCK_HZ = 10e6
PAPER_CLOCKS = 5_120_000
SIMULATED = (1, 2, 4, 8)
PAPER_CHIPS = 9
CORES = (1, 2, 4)
VIEW = "0,8.0625"  # into the room, a little from above: of the published figures
WHOLE = ["--no-skip", "culling,empty-tiles,divisions"]


def simulate(render, scene, options):
    """The statistics of the frame, rendered by one thread."""
    with tempfile.TemporaryDirectory() as folder:
        stats = pathlib.Path(folder) / "stats.json"
        subprocess.run([render, scene, "--size", "320x200", "--view", VIEW, "--threads", "1", "--quiet",
                        "--stats", stats, "--output", pathlib.Path(folder) / "frame", *options], check=True)
        return json.loads(stats.read_text())


def row(name, clocks, tests=None, size=None):
    """One line of the table; what is not known stays empty."""
    traffic = ["", "", ""] if size is None else [
        f"{size / tests:.0f}", f"{size / 1e6:,.1f}", f"{size / clocks * CLOCK_HZ / 1e6:,.0f}"]
    return [name, "" if tests is None else f"{tests:,.0f}", f"{clocks:,.0f}", f"{CLOCK_HZ / clocks:,.1f}",
            *traffic]


def pipelined(runs):
    """The rows of the pipelined unit: so many lanes as were simulated, and as many as the paper has chips."""
    rows = [row(f"  pipelined, {lanes} lane{'s' * (lanes > 1)}", run["clocks"], run["unit_tests"],
                run["input_bytes"]) for lanes, run in runs.items()]
    most = max(runs)
    tests, size = runs[most]["unit_tests"], runs[most]["input_bytes"]
    clocks = tests / PAPER_CHIPS + runs[most]["clocks"] - tests / most
    return [*rows, row(f"  pipelined, ~{PAPER_CHIPS} lanes", clocks, tests, size)]


def main():
    if len(sys.argv) != 3:
        print(__doc__.strip().splitlines()[-1], file=sys.stderr)
        sys.exit(2)
    render, scene = sys.argv[1:]
    plans = {(skips, lanes): ["--lanes", str(lanes), *(WHOLE if skips == "whole" else [])]
             for skips in ("whole", "culled") for lanes in SIMULATED}
    plans["serial"] = ["--unit", "serial", *WHOLE]
    for cores in CORES:
        plans["core", cores] = ["--unit", "core", "--arith", "behavioural", "--cores", str(cores)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = dict(zip(plans, pool.map(lambda plan: simulate(render, scene, plan), plans.values())))
    whole, culled = ({lanes: runs[skips, lanes] for lanes in SIMULATED} for skips in ("whole", "culled"))
    serial = runs["serial"]
    head = ["at 10 MHz", "tests", "clocks", "frames/s", "bytes/test", "MB/frame", "MB/s"]
    table = [row("the paper, one chip", PAPER_CLOCKS),
             row(f"the paper, {PAPER_CHIPS} chips", CLOCK_HZ / 18),
             [f"every ray on each of {serial['triangles']} polygons:"],
             row("  the paper's unit", serial["clocks"], serial["unit_tests"], serial["input_bytes"]),
             *pipelined(whole), ["with culling:"], *pipelined(culled), ["the tree walked in hardware:"],
             *(row(f"  ray core{f's, {cores}' * (cores > 1)}", run["clocks"], run["unit_tests"], run["input_bytes"])
               for cores in CORES for run in [runs["core", cores]])]
    widths = [max(len(line[k]) for line in [head, *table] if len(line) == len(head)) for k in range(len(head))]
    for line in [head, *table]:
        print(line[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(line[1:], widths[1:])),
              sep="  " if len(line) > 1 else "")
    print(f"{whole[1]['rays']:,} rays: {whole[1]['camera_rays']:,} from the camera,"
          f" {whole[1]['shadow_rays']:,} to lights, the others reflected or refracted")


if __name__ == "__main__":
    main()
