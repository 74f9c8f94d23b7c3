"""What exactness costs in pictures: doubts and the time spent on them, scene by scene."""

import json
import pathlib
import statistics
import subprocess
import tempfile

from host.lab.report.rows import ROOT


def run(scene: str, arguments: list[str]) -> dict:
    """Statistics of one render by the cpu engine, whose time is not that of a simulation."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "stats.json"
        subprocess.run([ROOT / "render", scene, "--engine", "cpu", "--quiet", "--stats", file,
                        "--output", pathlib.Path(folder) / "picture.exr", *arguments], check=True)
        return json.loads(file.read_text())


def row(scene: str, repeats: int, arguments: list[str]) -> dict:
    """Counts are the same in every run; of the shares of time, the median."""
    runs = [run(scene, arguments) for _ in range(repeats)]
    stats = runs[0]

    def share(part: str) -> float:
        return statistics.median(100 * each["thread_seconds"][part]
                                 / sum(each["thread_seconds"].values()) for each in runs)

    return {"table": "doubts", "scene": scene, "triangles": stats["triangles"],
            "rays": stats["rays"],
            "secondary_rays": stats["rays"] - stats["camera_rays"] - stats["shadow_rays"],
            "tests": stats["tests"], "edge_doubts": stats["edge_doubts"],
            "edge_doubts_percent": 100 * stats["edge_doubts"] / max(stats["tests"], 1),
            "depth_doubts": stats["depth_doubts"], "doubts_time_percent": share("doubts"),
            "origins_time_percent": share("departures")}
