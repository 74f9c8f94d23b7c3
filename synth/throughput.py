"""Tests a second for each unit, from its clock rate and the clocks that its simulation counts."""

import json
import pathlib
import re
import subprocess
import tempfile

from synth import store, tables, tools
from synth.catalogue import LIBRARIES

# Unit -> its word in table_1's last line.
COUNTED = {"hit_test_unit": "proposed", "general_hit_test_unit": "general"}
SCENE = ["scenes/paper.obj", "--size", "320x200", "--threads", "1"]


def simulated() -> dict[str, float]:
    """Clocks a test for each unit, as the programs of build/sim and ./render count them; what is not
    built is left out."""
    clocks = {}
    table_1, render = tools.ROOT / "build" / "sim" / "table_1", tools.ROOT / "render"
    if table_1.exists():
        said = subprocess.run([table_1], check=True, capture_output=True, text=True).stdout
        for unit, word in COUNTED.items():
            clocks[unit] = float(re.search(rf"{word} (\d+\.\d+)", said.splitlines()[-1]).group(1))
    if render.exists():
        with tempfile.TemporaryDirectory(dir=store.OUT) as folder:
            file = pathlib.Path(folder) / "stats.json"
            subprocess.run([render, *SCENE, "-q", "--stats", file, "-o", pathlib.Path(folder) / "x"],
                           check=True, cwd=tools.ROOT)
            clocks["hit_test_pipeline"] = json.loads(file.read_text())["clocks_per_test"]
    return clocks


def table(records: list[dict], clocks: dict[str, float] | None = None) -> str:
    """Tests a second, and for each square millimetre of cells, of every timed unit."""
    clocks = simulated() if clocks is None else clocks
    rows = []
    for library in LIBRARIES:
        for record in records:
            if record["target"] != library.name or record["top"] not in clocks or "from" not in record:
                continue
            rate = 1e9 / record["delay_ns"] / clocks[record["top"]]
            rows.append([record["design"], library.title, record["flow"],
                         f"{1000 / record['delay_ns']:.1f}", f"{clocks[record['top']]:.2f}",
                         f"{rate:,.0f}", f"{rate / record['area'] * 1e6:,.0f}"])
    if not rows:
        return ("No clocks a test: `make test` builds build/sim/table_1, and `make verilate` "
                "./render, which count them.\n")
    return tables.markdown(["unit", "library", "flow", "MHz", "clocks a test", "tests/s",
                            "tests/s and mm2 of cells"], rows)


def ray_table(record: dict, rows: list[dict] | None = None) -> str:
    """Rays a second of the ray core at the clock rate of `record`, by scene and kind of ray; `rows`: of `make bench ONLY=core`."""
    file = tools.ROOT / "build" / "results" / "core.jsonl"
    if record["top"] != "ray_core":
        return ""
    if rows is None and not file.exists():
        return "No clocks a ray: `make bench ONLY=core` counts them.\n"
    rows = rows or [json.loads(line) for line in file.read_text().splitlines()]
    clock = 1e9 / record["delay_ns"]
    return tables.markdown(["scene", "rays", "memory, clocks away", "clocks/ray", "million rays/s", "a mm2 of cells"], [
        [row["scene"], row["rays"], f"{row['latency']}", f"{row['clocks_per_ray']:.2f}",
         f"{clock / row['clocks_per_ray'] / 1e6:.2f}",
         f"{clock / row['clocks_per_ray'] / record['area']:.3f}"]
        for row in rows if row.get("part", "scenes") == "scenes" and row.get("latency") == 50])
