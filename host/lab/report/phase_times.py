"""What a picture takes from start to end: loading the scene, building the tree, rendering, writing the files."""

import json
import pathlib
import subprocess
import tempfile

from host.lab.report.rows import ROOT

PHASES = ("load", "tree", "render", "write", "total")


def measure(programs: list[pathlib.Path], scenes: list[str], arguments: list[str], repeats: int) -> list[dict]:
    """A row for each scene and program: seconds of each phase in each run; the programs take turns."""
    rows = [{"table": "phase_times", "scene": scene, "program": number, "seconds": {phase: [] for phase in PHASES}}
            for scene in scenes for number in range(len(programs))]
    with tempfile.TemporaryDirectory() as name:
        picture, stats = pathlib.Path(name) / "picture.exr", pathlib.Path(name) / "stats.json"
        for _ in range(repeats):
            for row in rows:
                subprocess.run([programs[row["program"]], row["scene"], "--engine", "cpu", "--quiet", "--output", picture,
                                "--stats", stats, *arguments], cwd=ROOT, check=True)
                found = json.loads(stats.read_text())
                row["triangles"] = found["triangles"]
                for phase in PHASES:
                    row["seconds"][phase].append(found["seconds"][phase])
    return rows
