"""The delay model, counted on a netlist of three cells."""

import unittest

from synth import unit_delay


def cell(kind: str, inputs: dict[str, int], outputs: dict[str, int]) -> dict:
    """A cell as Yosys's JSON has it, all ports of one bit."""
    return {"type": kind, "connections": {port: [bit] for port, bit in {**inputs, **outputs}.items()},
            "directions": {**dict.fromkeys(inputs, "input"), **dict.fromkeys(outputs, "output")}}


# Two full adders in a chain; the second one's sum through a multiplexer. Bits 2 to 5 are inputs.
MODULE = {
    "ports": {"a_i": {"bits": [2, 3]}, "sum_o": {"bits": [10, 12]}},
    "cells": [
        cell("FULL_ADDER", {"A": 2, "B": 4, "C": 5}, {"SUM": 10, "CARRY": 11}),
        cell("FULL_ADDER", {"A": 3, "B": 4, "C": 11}, {"SUM": 13, "CARRY": 14}),
        cell("MULTIPLEXER", {"WHEN_0": 13, "WHEN_1": 13, "SELECT": 5}, {"OUT": 12}),
    ],
}


class Count(unittest.TestCase):
    """unit_delay.count."""

    def test_countings(self):
        """The last multiplexer counts as the counting says."""
        every, carries = unit_delay.COUNTINGS[:2]
        self.assertEqual(unit_delay.count(MODULE, every)["delay"], 3)
        self.assertEqual(unit_delay.count(MODULE, carries)["delay"], 2)

    def test_cells(self):
        """Each kind's number."""
        self.assertEqual(unit_delay.cells(MODULE), {"full_adder": 2, "multiplexer": 1})


if __name__ == "__main__":
    unittest.main()
