"""Tables of the report."""

import unittest

from synth import report


class ClockTable(unittest.TestCase):
    """Of cells and of an FPGA."""

    def test_has_what_is_timed_in_ns_alone(self) -> None:
        cells = {"design": "hit_test_unit", "target": "osu035", "flow": "parts", "delay_ns": 50.0, "from": "N", "to": "output_q"}
        placed = {"design": "adder", "target": "ecp5", "flow": "placed", "mhz": 98.0, "from": "a", "to": "sum"}
        lines = report.clock_table([cells, placed]).splitlines()
        self.assertEqual(len(lines), 3)
        self.assertIn("20.0", lines[2])


if __name__ == "__main__":
    unittest.main()
