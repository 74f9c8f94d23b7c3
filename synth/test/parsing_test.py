"""What is read from the tools' reports."""

import unittest

from synth import mapping, tools

OPENSTA = """\
    Cap    Slew   Delay    Time   Description
---------------------------------------------------------------------
                   0.00    0.00   clock clock (rise edge)
                   0.00    0.00   clock network delay (ideal)
           0.03    0.01    0.01 ^ a_i[0] (in)
           0.03    0.00    0.01 ^ _1_/A (INVX1)
   0.04    0.05    0.12    0.13 v _1_/Y (INVX1)
           0.05    0.00    0.13 v _2_/D (DFFPOSX1)
                           0.13   data arrival time

                1000.00 1000.00   clock clock (rise edge)
                  -0.09  999.91   library setup time
                         999.91   data required time
"""


class Parsing(unittest.TestCase):
    """mapping's readers."""

    def test_critical_path(self):
        """Arrival and set-up time add up; steps are pins with their cells."""
        delay, steps = mapping.critical_path(OPENSTA)
        self.assertEqual(delay, 0.22)
        self.assertEqual([step["pin"] for step in steps],
                         ["a_i[0]", "_1_/A", "_1_/Y", "_2_/D"])
        self.assertEqual(steps[2]["delay"], 0.12)

    def test_registers(self):
        """A path's ends by what its registers hold; a port as itself."""
        netlist = "DFFPOSX1 _2_ (\n .CLK(clk_i),\n .D(n1),\n .Q(\\u_core.sum_q[3] )\n);\n"
        self.assertEqual(mapping.registers(netlist, [{"pin": "bus_i[0]"}, {"pin": "_2_/D"}]),
                         {"from": "bus_i[0]", "to": "u_core.sum_q[3]"})

    def test_no_path(self):
        """A design that was not timed is a failure, not 0 ns."""
        with self.assertRaises(tools.ToolFailed):
            mapping.critical_path("Error: netlist.v, line 3 syntax error\nNo paths found.\n")

    def test_cell_counts(self):
        """Area and cells of Yosys's statistics; no area is a failure."""
        stat = "     FAX1                           48\n\n   Chip area for module '\\top': 23040.0\n"
        self.assertEqual(mapping.cell_counts(stat), (23040, {"FAX1": 48}))
        with self.assertRaises(tools.ToolFailed):
            mapping.cell_counts("     FAX1                           48\n")


if __name__ == "__main__":
    unittest.main()
