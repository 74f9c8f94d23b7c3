"""What is drawn of one ray in time."""

import pathlib
import tempfile
import unittest

from synth import ray_timeline

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


if __name__ == "__main__":
    unittest.main()
