"""What is drawn: units and the words between them; one ray in time."""

import pathlib
import tempfile
import unittest

from synth import diagram, ray_timeline, waveform


def port(direction, *bits):
    """A port of a module in Yosys's JSON."""
    return {"direction": direction, "bits": list(bits)}


def cell(kind, inputs, outputs, **parameters):
    """A cell: its ports by name."""
    return {"type": kind, "parameters": parameters, "connections": {**inputs, **outputs},
            "port_directions": {**dict.fromkeys(inputs, "input"), **dict.fromkeys(outputs, "output")}}


class Units(unittest.TestCase):
    """diagram.units: a register between two units is passed, a select is not followed."""

    MODULE = {
        "ports": {"in_i": port("input", 2, 3), "out_o": port("output", 8, 9), "clk_i": port("input", 1)},
        "cells": {
            "u_first": cell("first$top.u_first", {"a_i": [2, 3]}, {"b_o": [4, 5], "c_o": [10]}),
            "register": cell("$dff", {"CLK": [1], "D": [4, 5]}, {"Q": [6, 7]}),
            "table": cell("$mem_v2", {"RD_ADDR": [10], "WR_DATA": [6, 7]}, {"RD_DATA": [11, 12]}, MEMID="\\table"),
            "select": cell("$mux", {"A": [11, 12], "B": [6, 7], "S": [10]}, {"Y": [13, 14]}),
            "u_last": cell("last$top.u_last", {"a_i": [13, 14]}, {"b_o": [8, 9]}),
        },
    }

    def test_words_are_followed_to_the_next_unit(self):
        nodes, arrows = diagram.units(self.MODULE, 2)
        self.assertEqual(nodes, {"in_i": ("port", "in_i"), "out_o": ("port", "out_o"), "u_first": ("core", "first"),
                                 "u_last": ("core", "last"), "table": ("memory", "table")})
        self.assertEqual(arrows, {("in_i", "u_first"), ("u_first", "table"), ("u_first", "u_last"), ("table", "u_last"),
                                  ("u_last", "out_o")})

    def test_narrow_words_are_left_out(self):
        self.assertEqual(diagram.units(self.MODULE, 3), ({}, set()))


TRACE = """\
$scope module top $end
$var wire 1 a clk_i $end
$var wire 2 b busy [1:0] $end
$upscope $end
$enddefinitions $end
#0
0a
b00 b
#10
1a
b01 b
#15
0a
#20
1a
b11 b
#25
0a
#30
1a
b00 b
#35
0a
#40
1a
b10 b
"""
SAVE_FILE = "@800200\n-all\n@28\n+{clock} top.clk_i\n@22\n+{busy} top.busy[1:0]\n@1000200\n-all\n"


class Timeline(unittest.TestCase):
    """ray_timeline."""

    def test_bars_are_clocks_that_are_not_zero(self):
        self.assertEqual(ray_timeline.bars([(0, "00"), (10, "01"), (20, "11"), (30, "xx"), (40, "10")],
                                           [10, 20, 30, 40]), [(0, 2), (3, 1)])

    def test_the_drawing_has_the_names(self):
        with tempfile.TemporaryDirectory() as name:
            out = pathlib.Path(name) / "a.svg"
            ray_timeline.draw(TRACE, SAVE_FILE, out)
            self.assertIn("<!-- busy -->", out.read_text())
        with self.assertRaises(KeyError):
            ray_timeline.draw(TRACE, SAVE_FILE.replace("busy[", "idle["), out)


class Noise(unittest.TestCase):
    def test_words_that_the_unit_does_not_take_are_crossed_out(self) -> None:
        """Edges at 10, 20, ...: a first word, one after it, then what the bus carries between tests."""
        word = [f"{number:032b}" for number in (7, 8, 9)]
        changes = {"top.hit_test_unit.bus_i[31:0]": [(0, word[0]), (15, word[1]), (25, word[2])],
                   "top.hit_test_unit.valid_i": [(0, "1"), (15, "0")],
                   "top.hit_test_unit.word[2:0]": [(0, "000"), (10, "001"), (20, "000")]}
        edges = [10, 20, 30]
        idle = waveform.noise(changes, edges)
        self.assertEqual(idle, {word[2]})
        self.assertEqual(waveform.lane("in", changes["top.hit_test_unit.bus_i[31:0]"], edges, idle),
                         {"name": "in", "wave": "==x", "data": ["00000007", "00000008"]})


if __name__ == "__main__":
    unittest.main()
