"""Documents, costs from synthesis, quantiles, and what is derived from rows."""

import pathlib
import tempfile
import unittest

from host.lab.bench import costs
from host.lab.report import document, plots
from host.lab.targets import bench, speed

VARIANT = {"table": "variants", "variant": "binary32", "unit": "serial", "exponent_bits": 8,
           "digits": 24, "rounding": "nearest-even", "flush": False, "quotient_digits": 0, "fused": False,
           "doubts": True, "hardware": True}


def core(top, area, delay, flow="small", **parameters):
    """A row of synthesis."""
    return {"table": "synthesis", "top": top, "design": top, "target": "osu035", "flow": flow,
            "area": area, "delay_ns": delay, "parameters": parameters}


class Document(unittest.TestCase):
    def test_cells(self):
        text = document.table([{"n": 1234, "what": "one"}, {"what": "none"}], "n :,", "what")
        self.assertEqual([[cell.strip() for cell in line.split("|")[1:-1]]
                          for line in text.splitlines()[2:]], [["1,234", "one"], ["-", "none"]])

    def test_columns_compute(self):
        row = {"scene": "scenes/a.obj", "at": {50: {"clocks": 3}}, "hits": 1, "rays": 0}
        text = document.table([row], "scene = scene_name(row)", document.each([50, 99], "clocks, {} = at[{}].clocks :.2f"),
                              "hits per ray = hits / rays :.1f", "sides: left = 'x' if hits == 1 else 'y'")
        self.assertEqual([[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines()[::2]],
                         [["scene", "clocks, 50", "clocks, 99", "hits per ray", "sides: left"], ["a", "3.00", "-", "-", "x"]])

    def test_long_tables_are_files(self):
        with tempfile.TemporaryDirectory() as name:
            file = pathlib.Path(name) / "long.csv"
            self.assertEqual(document.save(file, [{"n": 1234, "what": "a, b"}, {"what": "none"}], "n :,", "what"), "[long.csv](long.csv)")
            self.assertEqual(file.read_text(), 'n,what\n1234,"a, b"\n,none\n')

class Rows(unittest.TestCase):
    def test_the_best_of_embrees_modes_counts(self):
        rows = [{"table": "rays", "scene": "a", "rays": "light", "by": by, "mrays_per_second": rate, "spread_percent": 5.0}
                for by, rate in (("raygate", 6.0), ("Embree 8", 10.0), ("Embree 4 16", 12.0), ("Embree 1 robust", 5.0))]
        (found,) = speed.values(rows, pathlib.Path())["over_best"]
        self.assertEqual((found["fast"], found["fast_mode"]), ("0.50 ± 0.05", "Embree 4 16"))
        self.assertEqual((found["robust"], found["robust_mode"]), ("1.20 ± 0.12", "Embree 1"))


class Plots(unittest.TestCase):
    def test_front(self):
        # 1 is worse than 0 in both; 3 equals 0 in x and is worse; 4 is best in y.
        points = [(1, 5), (2, 6), (3, 2), (1, 7), (9, 1)]
        self.assertEqual(plots.front(points), [0, 2, 4])


class Costs(unittest.TestCase):
    UNITS = [core("hit_test_unit", 50, 20.0), core("hit_test_unit", 7, 6.0, FracWidth="15", flow="parts")]

    def test_a_unit_in_its_format(self):
        self.assertEqual(costs.unit(self.UNITS, VARIANT)["area"], 50)
        self.assertEqual(costs.unit(self.UNITS, {**VARIANT, "digits": 16})["area"], 7)

    def test_unknown_formats_cost_nothing_known(self):
        self.assertIsNone(costs.unit(self.UNITS, {**VARIANT, "digits": 12}))
        self.assertIsNone(costs.unit(self.UNITS, {**VARIANT, "fused": True}))
        self.assertIsNone(costs.unit([core("hit_test_unit", 1, 1.0, Arith="2")], VARIANT))


class Frames(unittest.TestCase):
    def test_a_frame(self):
        row = {"table": "pictures", "scene": "scenes/a.obj",
               "variant": "binary32", "engine": "model", "unit_tests": 1000, "clocks": 0,
               "decisions": {"wrong_hits": 1, "wrong_misses": 1, "tests": 500, "doubts": 0,
                             "point_ulp": {"p99": 2.0}}}
        simulated = {key: value for key, value in row.items() if key != "decisions"}
        simulated |= {"engine": "unit", "unit_tests": 100, "clocks": 700}
        (frame,) = bench.frames([row, simulated, {**VARIANT, "variant": "serial"}, VARIANT,
                                 core("hit_test_unit", 50, 20.0)])
        self.assertEqual((frame["scene"], frame["clocks"], frame["wrong"]), ("a", 7000, 4000))
        self.assertFalse(frame["clocks_modelled"])
        self.assertAlmostEqual(frame["frame_ms"], 0.14)
        self.assertAlmostEqual(frame["area_time"], 7.0)
