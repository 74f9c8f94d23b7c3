"""The report of `make bench ONLY=core`."""

import pathlib
import tempfile
import unittest

from host.lab.report import document
from host.lab.targets import core


def row(run, rays, latency, **values):
    """A row of `lab core`."""
    return {"table": "core", "part": run, "scene": "a", "rays": rays, "latency": latency, "cores": 1,
            "clocks_per_ray": latency / 10, "lines_per_ray": 0.5, "bytes_per_ray": 32.0, "nodes_percent": 70.0,
            "triangles_percent": 80.0, "waits_percent": 1.5, "doubts_per_1000": 0.25, **values}


class CoreReport(unittest.TestCase):
    def test_a_row_has_the_clocks_of_all_latencies(self):
        with tempfile.TemporaryDirectory() as name:
            rows = (
                [*(row("scenes", "camera", latency) for latency in (1, 50, 200)),
                 *(row("cores", "camera", 50, cores=cores, clocks_per_ray=6 / cores) for cores in (1, 2)),
                 row("exact", "path", 50, exact=False, clocks_per_ray=4.0),
                 row("exact", "path", 50, exact=True, clocks_per_ray=5.0, near_ties_per_1000=2.0, exact_percent=1.25)])
            text = document.render("core.md.j2", pathlib.Path(name), rows, **core.values(rows, pathlib.Path(name)))
            saved = (pathlib.Path(name) / "core-scenes.csv").read_text().splitlines()[1]
        self.assertEqual(saved, "a,camera,0.10,5.00,20.00,0.50,32,70.0,80.0,0.25")
        rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines() if line.startswith("| a ")]
        self.assertEqual(rows, [
            ["a", "camera", "0.10", "5.00", "20.00", "0.25"],
            ["a", "path", "4.00", "5.00", "25.0", "0.25", "2.00", "1.25"],
            ["a", "camera", "6.00", "3.00", "1.5"]])
