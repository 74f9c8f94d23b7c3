"""What exactness costs in pictures: doubts and the time spent on them, scene by scene.

    python3 host/lab/stress/doubts.py [--render ./render] [--size 640x480] SCENE...
"""

import argparse
import json
import pathlib
import subprocess
import tempfile


def statistics(render: pathlib.Path, scene: pathlib.Path, arguments: list[str]) -> dict:
    """Those of one render of the cpu engine, whose time is not that of a simulation."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "stats.json"
        subprocess.run([render, scene, "--engine", "cpu", "--quiet", "--stats", file,
                        "--output", pathlib.Path(folder) / "picture.exr", *arguments], check=True)
        return json.loads(file.read_text())


def row(name: str, runs: list[dict]) -> list[str]:
    """Counts are the same in every run; of the shares of time, the median."""
    stats = runs[0]
    edges, depths = stats["edge_doubts"], stats["depth_doubts"]
    others = stats["rays"] - stats["camera_rays"] - stats["shadow_rays"]

    def share(part: str) -> float:
        shares = sorted(run["thread_seconds"][part] / sum(
            run["thread_seconds"][key] for key in ("boxes", "records", "hit_tests", "doubts", "departures", "shading")) for run in runs)
        return 100 * shares[len(shares) // 2]

    return [name, f"{stats['triangles']:,}", f"{stats['rays']:,}", f"{others:,}",
            f"{stats['tests']:,}", f"{edges:,}", f"{100 * edges / max(stats['tests'], 1):.4f} %",
            f"{depths:,}", f"{share('doubts'):.2f} %",
            f"{share('departures'):.2f} %"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--render", type=pathlib.Path, default=pathlib.Path("render"))
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--repeats", type=int, default=3)
    options, more = parser.parse_known_args()
    head = ["scene", "triangles", "rays", "reflected, refracted", "tests", "doubts about edges",
            "of the tests", "about depth", "time on doubts", "on rays' origins"]
    print("| " + " | ".join(head) + " |\n|---|" + "---:|" * (len(head) - 1))
    for scene in options.scenes:
        runs = [statistics(options.render.absolute(), scene, ["--size", options.size, *more])
                for _ in range(options.repeats)]
        print("| " + " | ".join(row(scene.stem, runs)) + " |", flush=True)
    print("\nTime: of all threads in the render, cpu engine; the simulated ones take the same doubts"
          "\nand far more time for the rest. Origins of reflected and refracted rays are exact too.")


if __name__ == "__main__":
    main()
