"""What is written and compared: tables, tests a second."""

import unittest

from synth import tables, throughput


class Tables(unittest.TestCase):
    """tables' two forms."""

    def test_markdown(self):
        """Columns line up, numbers to the right."""
        self.assertEqual(tables.markdown(["what", "ns"], [["a", "9.5"], ["b", "10.5"]]),
                         "| what |   ns |\n|------|-----:|\n| a    |  9.5 |\n| b    | 10.5 |\n")

    def test_comma_separated(self):
        """What a row has not is left empty; what is not asked for is left out."""
        self.assertEqual(tables.comma_separated([{"a": 1, "c": 2}], ["a", "b"]), "a,b\n1,\n")


class Rays(unittest.TestCase):
    """throughput.ray_table."""

    def test_rays_a_second(self):
        """100 MHz, 2 clocks a ray: 50 million a second, of 10 mm2."""
        text = throughput.ray_table({"top": "ray_core", "delay_ns": 10.0, "area": 10_000_000}, [
            {"scene": "a", "rays": "camera", "latency": 50, "clocks_per_ray": 2.0},
            {"scene": "a", "rays": "camera", "latency": 1, "clocks_per_ray": 1.0}])
        self.assertEqual([cell.strip() for cell in text.splitlines()[2].split("|")[1:-1]],
                         ["a", "camera", "50", "2.00", "50.00", "5.000"])
        self.assertEqual(len(text.splitlines()), 3)


if __name__ == "__main__":
    unittest.main()
