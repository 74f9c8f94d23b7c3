"""What a picture takes from start to end: loading the scene, building the tree, rendering, writing the files."""

import json
import pathlib
import subprocess
import tempfile

from host.lab.report.rows import ROOT

STAGES = ("load", "tree", "render", "write", "total")


def measure(programs: list[pathlib.Path], scenes: list[str], arguments: list[str], repeats: int) -> list[dict]:
    """A row for each scene and program: seconds of each stage in each run; the programs take turns."""
    rows = [{"table": "stages", "scene": scene, "program": number, "seconds": {stage: [] for stage in STAGES}}
            for scene in scenes for number in range(len(programs))]
    with tempfile.TemporaryDirectory() as name:
        picture, stats = pathlib.Path(name) / "picture.exr", pathlib.Path(name) / "stats.json"
        for _ in range(repeats):
            for row in rows:
                subprocess.run([programs[row["program"]], row["scene"], "--engine", "cpu", "--quiet", "--output", picture,
                                "--stats", stats, *arguments], cwd=ROOT, check=True)
                found = json.loads(stats.read_text())
                row["triangles"] = found["triangles"]
                for stage in STAGES:
                    row["seconds"][stage].append(found["seconds"][stage])
    return rows
