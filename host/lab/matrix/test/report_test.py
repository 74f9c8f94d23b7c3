"""The document's two forms, costs from synthesis, and what is derived from rows."""

import pathlib
import tempfile
import unittest

from host.lab.matrix import claims, costs, derive, document

VARIANT = {"name": "binary32", "unit": "serial", "exponent_bits": 8, "digits": 24, "rounding": 0,
           "flush": False, "quotient_digits": 0, "fused": False, "doubts": True, "hardware": True}


def core(top, area, delay, **parameters):
    """A record of synthesis."""
    return {"top": top, "design": top, "target": "osu035", "flow": "small", "area": area,
            "delay_ns": delay, "parameters": parameters}


class Document(unittest.TestCase):
    def test_both_forms(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = pathlib.Path(folder) / "a.svg"
            picture.write_text("<svg/>")
            blocks = [document.Heading(2, "A < B"), document.Text("**all** of `x < y`"),
                      document.Table(["n", "what"], [["1", "one"]]),
                      document.Figure(picture, "a picture")]
            text = document.markdown(blocks, pathlib.Path(folder))
            self.assertIn("## A < B\n", text)
            self.assertIn("![a picture](a.svg)", text)
            self.assertIn("| 1 | one  |", text)
            page = document.page(blocks, "title")
            self.assertIn("<h2>A &lt; B</h2>", page)
            self.assertIn("<strong>all</strong> of <code>x &lt; y</code>", page)
            self.assertIn('<td class="number">1</td><td>one</td>', page)
            self.assertIn("data:image/svg+xml;base64,PHN2Zy8+", page)
            self.assertNotIn(folder, page)


class Costs(unittest.TestCase):
    CORES = [core("fp_multiplier", 10, 5.0), core("fp_adder", 4, 3.0, Adder="2"),
             core("fp_divider", 20, 9.0), core("fp_divider", 7, 6.0, FracWidth="15")]

    def test_cores_add_up(self):
        cost = costs.cost(self.CORES, VARIANT)
        self.assertEqual((cost.area, cost.period_ns), (34, 14.0))

    def test_a_unit_goes_before_its_cores(self):
        cost = costs.cost([*self.CORES, core("hit_test_unit", 50, 20.0)], VARIANT)
        self.assertEqual((cost.area, cost.period_ns), (50, 20.0))

    def test_unknown_formats_cost_nothing_known(self):
        self.assertIsNone(costs.cost(self.CORES, {**VARIANT, "digits": 16}))
        self.assertIsNone(costs.cost(self.CORES, {**VARIANT, "fused": True}))
        self.assertIsNone(costs.cost([core("fp_multiplier", 1, 1.0, Adder="0")], VARIANT))


class Derive(unittest.TestCase):
    def test_a_frame(self):
        row = {"section": "variants", "scene": "scenes/a.obj", "variant": "binary32",
               "engine": "cpu", "unit_tests": 1000, "clocks": 0, "exact_inside": 1,
               "exact_depth": 2, "decisions": {"wrong_hits": 1, "wrong_misses": 1, "tests": 500}}
        simulated = {**row, "engine": "unit", "unit_tests": 100, "clocks": 700}
        (frame,) = derive.frames([row, simulated], [VARIANT], [core("hit_test_unit", 50, 20.0)])
        self.assertEqual(frame["clocks"], 7000)
        self.assertFalse(frame["clocks_modelled"])
        self.assertAlmostEqual(frame["frame_ms"], 0.14)
        self.assertAlmostEqual(frame["area_time"], 7.0)
        self.assertEqual(derive.wrong_per_million(frame), 4000)


class Claims(unittest.TestCase):
    def test_words_on_the_bus(self):
        line = "   8  Ix " + " ".join(["40540000"] * 7)
        self.assertEqual(claims.bus_words(f"edge in\n{line} 3DC873F8\n{line}\n"), ["3DC873F8"])


if __name__ == "__main__":
    unittest.main()
