"""Tests documents, costs from synthesis, and values derived from rows."""

import pathlib
import tempfile
import unittest

from host.lab.report import document
from host.lab.targets import bench, core, costs, speed, stress
from synth import catalogue

VARIANT = {"table": "variants", "variant": "binary32", "unit": "serial", "exponent_bits": 8,
           "digits": 24, "rounding": "nearest-even", "flush": False, "quotient_digits": 0, "fused": False,
           "doubts": True, "hardware": True}


def unit(top, area, delay, flow="small", **parameters):
    """Returns a row of synthesis results."""
    return {"table": "synthesis", "top": top, "design": top, "target": "osu035", "flow": flow,
            "area": area, "delay_ns": delay, "parameters": parameters}


def core_row(run, rays, latency, **values):
    """Returns a row of `lab core`."""
    return {"table": "core", "part": run, "scene": "a", "rays": rays, "latency": latency,
            "clocks_per_ray": latency / 10, "lines_per_ray": 0.5, "bytes_per_ray": 32.0, "nodes_percent": 70.0,
            "triangles_percent": 80.0, "doubts_per_1000": 0.25, **values}


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

    def test_lines_are_wrapped_but_for_tables(self):
        long = " ".join(["word"] * 40)
        page = document.wrap(f"# A\n\n{long}\nmore\n* {long}\n* b\n\n| {long} |\n\n\n\n![a](b)\n")
        lines = page.splitlines()
        self.assertEqual([line[:6] for line in lines], ["# A", "", "word w", "word w", "* word", "  word", "* b", "", "| word", "", "![a](b"])
        self.assertLessEqual(max(len(line) for line in lines if line[:1] != "|"), 120)


class Rows(unittest.TestCase):
    def test_the_best_of_embrees_modes_counts(self):
        rows = [{"table": "rays", "scene": scene, "rays": "light", "by": by, "mrays_per_second": 6 / ratio, "raygate_over_peer": ratio,
                 "lower_quartile": ratio - 0.04, "upper_quartile": 1.02 * ratio + 0.04}
                for scene, by, ratio in (("a", "raygate", 1), ("a", "Embree3-8", 0.6), ("a", "Embree4-16", 0.5), ("a", "Embree3-1 robust", 1.2),
                                         ("b", "raygate", 1), ("b", "Embree3-8", 0.6), ("b", "Embree4-8 robust", 0.5))]
        a, b = speed.values(rows, pathlib.Path())["over_best"]
        self.assertEqual((a["fast"], a["fast_mode"], a["robust"], a["robust_mode"]), ("0.50 (0.46 to 0.55)", "Embree4-16", "1.2 (1.2 to 1.3)", "Embree3-1"))
        self.assertEqual((b["fast_mode"], b["robust_mode"]), ("Embree4-8 robust", "Embree4-8"))

    def test_stress_fails_where_an_exact_subject_is_wrong(self):
        row = {"table": "stress", "suite": "a", "subject": "b", "subject_is": "", "suite_is": "", "exact": True, "simulated": False, "binary64": False,
               "spotless": True, "broken_claims": 0, "seconds": 1.0, "failures": []} | dict.fromkeys(
                   (*stress.COUNTS, *stress.LARGEST), 0) | {"tests": 5, "rays": 5}

        def failures(**changed):
            return stress.failures([row | changed])

        self.assertEqual(failures(), [])
        self.assertEqual(failures(exact=False, spotless=False), [])
        for changed in ({"tests": 0}, {"spotless": False, "failures": ["00000000"]}, {"broken_claims": 1}):
            self.assertEqual(len(failures(**changed)), 1)
        self.assertTrue(failures(spotless=False, failures=["00000000"])[0].endswith("\n00000000"))
        with tempfile.TemporaryDirectory() as name:
            rows = [{"table": "machine", "command": "make stress"}, row, row | {"subject": "c", "exact": False, "tests": 9, "wrong": 2},
                    row | {"suite": "a 64", "binary64": True}]
            page = document.render(stress.PAGE, pathlib.Path(name), rows, **stress.values(rows, pathlib.Path(name)))
        self.assertIn("**Passed**: 2 suites, 10 cases, 5 of them with binary64 vertices, 0 by the simulated hardware, by `make stress`", page)


class CoreReport(unittest.TestCase):
    def test_a_row_has_the_clocks_of_all_latencies(self):
        with tempfile.TemporaryDirectory() as name:
            rows = (
                [*(core_row("scenes", "camera", latency) for latency in (1, 50, 200)),
                 core_row("exact", "path", 50, exact=False, clocks_per_ray=4.0),
                 core_row("exact", "path", 50, exact=True, clocks_per_ray=5.0, near_ties_per_1000=2.0, exact_percent=1.25)])
            text = document.render(core.PAGE, pathlib.Path(name), rows, **core.values(rows, pathlib.Path(name)))
            saved = (pathlib.Path(name) / "core-scenes.csv").read_text().splitlines()[1]
        self.assertEqual(saved, "a,camera,0.10,5.00,20.00,0.50,32,70.0,80.0,0.25")
        rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines() if line.startswith("| a ")]
        self.assertEqual(rows, [["a", "5.00"], ["a", "4.00", "5.00"]])


class Costs(unittest.TestCase):
    UNITS = [unit("hit_test_unit", 50, 20.0), unit("hit_test_unit", 7, 6.0, FracWidth="15", flow="parts")]

    def test_a_unit_in_its_format(self):
        self.assertEqual(costs.unit(self.UNITS, VARIANT)["area"], 50)
        self.assertEqual(costs.unit(self.UNITS, {**VARIANT, "digits": 16})["area"], 7)

    def test_a_design_is_measured(self):
        adder = catalogue.design("adder", adder="ripple", Width=3)
        (found,) = costs.measured("", {adder.name: catalogue.Row("variants", adder, {costs.LIBRARY: ("fast",)})}, 1)
        self.assertGreater(found["area"], 0)
        self.assertEqual(found["brought"], "")

    def test_unknown_formats_cost_nothing_known(self):
        self.assertIsNone(costs.unit(self.UNITS, {**VARIANT, "digits": 12}))
        self.assertIsNone(costs.unit(self.UNITS, {**VARIANT, "fused": True}))
        self.assertIsNone(costs.unit([unit("hit_test_unit", 1, 1.0, Arith="2")], VARIANT))


class Frames(unittest.TestCase):
    def test_a_frame(self):
        row = {"table": "pictures", "scene": "scenes/a.obj",
               "variant": "binary32", "engine": "model", "unit_tests": 1000, "clocks": 0,
               "decisions": {"wrong_hits": 1, "wrong_misses": 1, "tests": 500, "doubts": 0,
                             "point_ulp": {"p99": 2.0}}}
        simulated = {key: value for key, value in row.items() if key != "decisions"}
        simulated |= {"engine": "unit", "unit_tests": 100, "clocks": 700}
        (frame,) = bench.frames([row, simulated, {**VARIANT, "variant": "serial"}, VARIANT, unit("hit_test_unit", 50, 20.0)])
        self.assertEqual((frame["scene"], frame["clocks"], frame["wrong"]), ("a", 7000, 4000))
        self.assertFalse(frame["clocks_modelled"])
        self.assertAlmostEqual(frame["frame_ms"], 0.14)
        self.assertAlmostEqual(frame["area_time"], 7.0)
