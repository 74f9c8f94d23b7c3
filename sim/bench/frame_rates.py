"""Prints what the paper's frame takes: clocks, and frames a second at 10 MHz, for 1 to 10 lanes.

The paper's frame is scenes/paper.obj at 320 x 200, 4 bounces. 1, 2, 4 and 8 lanes are simulated by
`render`; the lanes between are calculated from them (marked ~): the tests, evenly shared, and for each
lane as many idle clocks as the nearest simulated number had. Beside them the paper's own figures: 5,120,000
clocks on one chip at 10 MHz, 18 frames a second on nine.

usage: frame_rates.py RENDER SCENE
"""

import json
import pathlib
import subprocess
import sys
import tempfile

CLOCK_HZ = 10e6
PAPER_CLOCKS = 5_120_000
PAPER_CHIPS = {1: CLOCK_HZ / PAPER_CLOCKS, 9: 18.0}  # frames a second
SIMULATED = (1, 2, 4, 8)


def simulate(render, scene, lanes, folder):
    """The statistics of the frame, rendered with so many lanes and nothing else beside."""
    stats = pathlib.Path(folder) / "stats.json"
    subprocess.run([render, scene, "--size", "320x200", "--threads", "1", "--lanes", str(lanes), "--quiet",
                    "--stats", stats, "--output", pathlib.Path(folder) / "frame"], check=True)
    return json.loads(stats.read_text())


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip().splitlines()[-1])
    with tempfile.TemporaryDirectory() as folder:
        runs = {lanes: simulate(sys.argv[1], sys.argv[2], lanes, folder) for lanes in SIMULATED}
    tests = runs[1]["tests"]
    idle = {lanes: run["clocks"] - run["tests"] / lanes for lanes, run in runs.items()}
    print(f"{tests:,} tests, {runs[1]['rays']:,} rays")
    print(f"{'lanes':>5} {'clocks':>10} {'a test':>7} {'x lanes':>8} {'frames/s':>9} {'the paper':>10}")
    for lanes in range(1, 11):
        near = min(SIMULATED, key=lambda known: abs(known - lanes))
        clocks = runs[lanes]["clocks"] if lanes in runs else tests / lanes + idle[near]
        mark = " " if lanes in runs else "~"
        paper = f"{PAPER_CHIPS[lanes]:10.1f}" if lanes in PAPER_CHIPS else ""
        print(f"{lanes:5} {mark}{clocks:9,.0f} {clocks / tests:7.4f} {clocks / tests * lanes:8.3f}"
              f" {CLOCK_HZ / clocks:9.1f} {paper}")


if __name__ == "__main__":
    main()
