"""Documents, costs from synthesis, quantiles, and what is derived from rows."""

import math
import pathlib
import tempfile
import unittest

from host.lab.bench import costs
from host.lab.report import document, statistics
from host.lab.targets import bench, speed, stress

VARIANT = {"table": "variants", "variant": "binary32", "unit": "serial", "exponent_bits": 8,
           "digits": 24, "rounding": "nearest-even", "flush": False, "quotient_digits": 0, "fused": False,
           "doubts": True, "hardware": True}


def core(top, area, delay, **parameters):
    """A row of synthesis."""
    return {"table": "synthesis", "top": top, "design": top, "target": "osu035", "flow": "small",
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

    def test_a_page_has_its_pictures_in_it(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "a.png").write_bytes(b"<png/>")
            page = document.page("# A < B\n\n**all** of `x < y`\n\n| n |\n|--:|\n| 1 |\n\n"
                                 "![a picture](a.png)\n", folder)
            for wanted in ("<title>A &lt; B</title>", "<h1>A &lt; B</h1>", "<strong>all</strong>",
                           "<code>x &lt; y</code>", '<td style="text-align: right;">1</td>',
                           "data:image/png;base64,PHBuZy8+"):
                self.assertIn(wanted, page)
            self.assertNotIn(name, page)


PROFILE = """\
fn=(1) render
cfn=(2) raygate::RaySpawner::find(...)
calls=3 0
10 100
fn=(2)
5 60
cfn=(3) raygate::RaySpawner::search(...)
calls=1 0
7 40
fn=(4) other
cfn=(3)
calls=1 0
8 15
"""


class Profile(unittest.TestCase):
    def test_a_part_that_calls_itself_counts_once(self):
        self.assertEqual(speed.inside(speed.calls(PROFILE), speed.PARTS_OF_A_PICTURE["departures"]), 115)


class Rows(unittest.TestCase):
    def test_the_best_of_embrees_modes_counts(self):
        rows = [{"table": "rays", "scene": "a", "rays": "light", "by": by, "mrays_per_second": rate, "spread_percent": 5.0}
                for by, rate in (("raygate", 6.0), ("Embree 8", 10.0), ("Embree 4 16", 12.0), ("Embree 1 robust", 5.0))]
        (found,) = speed.values(rows, pathlib.Path())["over_best"]
        self.assertEqual((found["fast"], found["fast_mode"]), ("0.50 ± 0.05", "Embree 4 16"))
        self.assertEqual((found["robust"], found["robust_mode"]), ("1.20 ± 0.12", "Embree 1"))

    def test_quantiles_of_bins_of_several_runs(self):
        parts = [{"max": 3.0, "bins": [[1.0, 60], [4.0, 38]]}, {"max": 7.0, "bins": [[8.0, 2]]}]
        self.assertEqual(stress.summary(parts), {"count": 100, "median": 1.0, "p99": 7.0, "max": 7.0})
        self.assertEqual(stress.summary([{"max": 0, "bins": []}])["median"], None)
        endless = stress.summary([{"max": None, "bins": [[2.0**64 * 65 / 64, 1]]}])
        self.assertEqual(endless["median"], math.inf)


class Statistics(unittest.TestCase):
    def test_spread(self):
        # Distances from 10: 0, 1, 1, 2, 90. One wild value doesn't count.
        self.assertEqual(statistics.spread([10, 9, 11, 12, 100]), 1 / 11)
        self.assertEqual(statistics.spread([5.0]), 0)

    def test_front(self):
        # 1 is worse than 0 in both; 3 equals 0 in x and is worse; 4 is best in y.
        points = [(1, 5), (2, 6), (3, 2), (1, 7), (9, 1)]
        self.assertEqual(statistics.front(points), [0, 2, 4])


class Costs(unittest.TestCase):
    CORES = [core("fp_multiplier", 10, 5.0), core("fp_adder", 4, 3.0, Arith="0"),
             core("fp_divider", 20, 9.0), core("fp_divider", 7, 6.0, FracWidth="15")]

    def test_cores_add_up(self):
        self.assertEqual(costs.cost(self.CORES, VARIANT), costs.Cost(34, 14.0))

    def test_a_unit_goes_before_its_cores(self):
        self.assertEqual(costs.cost([*self.CORES, core("hit_test_unit", 50, 20.0)], VARIANT),
                         costs.Cost(50, 20.0))

    def test_unknown_formats_cost_nothing_known(self):
        self.assertIsNone(costs.cost(self.CORES, {**VARIANT, "digits": 16}))
        self.assertIsNone(costs.cost(self.CORES, {**VARIANT, "fused": True}))
        self.assertIsNone(costs.cost([core("fp_multiplier", 1, 1.0, Arith="2")], VARIANT))


ENERGIES = [{"table": "energy", "top": top, "exponent": 8, "significand": 24, "pj": pj, "a_test": count}
            for top, pj, count in (("fp_multiplier", 100, 6), ("fp_adder", 50, 2), ("fp_divider", 300, 1))]


class Energies(unittest.TestCase):
    def test_operations_add_up(self):
        self.assertEqual(costs.energy(ENERGIES, VARIANT), 1.0)

    def test_what_was_not_simulated_is_not_known(self):
        self.assertIsNone(costs.energy(ENERGIES[:2], VARIANT))
        for change in ({"digits": 16}, {"unit": "pipeline"}, {"quotient_digits": 21}, {"fused": True}):
            self.assertIsNone(costs.energy(ENERGIES, {**VARIANT, **change}))


class Frames(unittest.TestCase):
    def test_a_frame(self):
        row = {"table": "pictures", "section": "variants", "scene": "scenes/a.obj",
               "variant": "binary32", "engine": "model", "unit_tests": 1000, "clocks": 0,
               "decisions": {"wrong_hits": 1, "wrong_misses": 1, "tests": 500, "doubts": 0,
                             "point_ulp": {"p99": 2.0}}}
        simulated = {**row, "engine": "unit", "unit_tests": 100, "clocks": 700}
        (frame,) = bench.frames([row, simulated, {**VARIANT, "variant": "serial"}, VARIANT,
                                 core("hit_test_unit", 50, 20.0), *ENERGIES])
        self.assertEqual((frame["scene"], frame["clocks"], frame["wrong"]), ("a", 7000, 4000))
        self.assertFalse(frame["clocks_modelled"])
        self.assertAlmostEqual(frame["frame_ms"], 0.14)
        self.assertAlmostEqual(frame["area_time"], 7.0)
        self.assertAlmostEqual(frame["energy_uj"], 1.0)


if __name__ == "__main__":
    unittest.main()
