#!/usr/bin/env python3
"""What --point-error costs and changes: a table of one run; host/intersect/README.md sums it up.

    python3 -B host/intersect/point_error.py [--repeats N] [SCENE ...]

Renders each scene with 0 (the host computes every point), the default and inf (the unit's wherever
it has one), with one thread of the cpu engine, in turns; compares with the first.
"""
import argparse
import json
import math
import pathlib
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ["cornell.obj", "cornell_spheres.json", "paper_room.json", "still_life.json", "columns.json",
          "sphereflake.json", "teapot.obj"]
ERRORS = ["0", "2^-16", "inf"]


def run(*command):
    return subprocess.run([str(word) for word in command], cwd=ROOT, check=True, capture_output=True, text=True).stdout


def render(scene, error, folder):
    """Seconds of processor time, and the run's statistics."""
    stats = folder / "stats.json"
    option = [] if error == "2^-16" else ["--point-error", error]  # it is the default
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    run("build/render", scene, "--engine", "cpu", "--threads", 1, "--size", "640x480", "--spp", 4, "--channels", "P",
        "--quiet", "--stats", stats, "-o", folder / f"{error}.exr", *option)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    return seconds, json.loads(stats.read_text())


def diagonal(scene):
    """Of the box around the scene's vertices."""
    if scene.suffix == ".json":
        scene = scene.parent / json.loads(scene.read_text())["obj"]
    corners = [[float(word) for word in line.split()[1:4]] for line in scene.read_text().splitlines()
               if line.startswith("v ")]
    return math.dist([min(axis) for axis in zip(*corners)], [max(axis) for axis in zip(*corners)])


def difference(folder, error, channels):
    return json.loads(run("build/compare", folder / f"{error}.exr", folder / "0.exr", "--channels", channels, "--json"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", default=SCENES)
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args()
    print("| Scene | `--point-error` | points by the host, % | processor time, of 0's | pixels: RMSE | pixels: max | "
          "P: max, of the scene's diagonal |\n|---|---|---|---|---|---|---|")
    for name in options.scenes:
        scene = ROOT / "scenes" / name
        with tempfile.TemporaryDirectory() as made:
            folder = pathlib.Path(made)
            seconds, stats = {error: [] for error in ERRORS}, {}
            for _ in range(options.repeats):
                for error in ERRORS:
                    taken, stats[error] = render(scene, error, folder)
                    seconds[error].append(taken)
            hits = stats["0"]["point_doubts"]  # all of them
            for error in ERRORS:
                pixels, points = (difference(folder, error, names) for names in ("R,G,B", "P.X,P.Y,P.Z"))
                print(f"| {scene.stem} | {error} | {100 * stats[error]['point_doubts'] / hits:.2f} | "
                      f"{min(seconds[error]) / min(seconds['0']):.3f} | {pixels['rmse']:.1e} | {pixels['max']:.1e} | "
                      f"{points['max'] / diagonal(scene):.1e} |", flush=True)


if __name__ == "__main__":
    try:
        main()
    except subprocess.CalledProcessError as error:
        print(error.stderr, end="", file=sys.stderr)
        sys.exit(2)
