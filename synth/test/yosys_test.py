"""Tests synth.yosys, and flows that run Yosys."""

import collections
import contextlib
import io
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

from synth import catalogue, mapping, scripts, tools, yosys


SOURCE = """\
module part #(parameter int Width = 1) (input logic [Width-1:0] a_i, output logic [Width-1:0] y_o);
  assign y_o = ~a_i;
endmodule
module top #(parameter int Width = 2) (input logic [Width-1:0] a_i, output logic [Width-1:0] y_o, z_o, output logic bit_o);
  part #(.Width(Width)) u_first (.a_i, .y_o);
  part #(.Width(Width)) u_second (.a_i(y_o), .y_o(z_o));
  part u_third (.a_i(a_i[0]), .y_o(bit_o));
endmodule
"""


class Yosys(unittest.TestCase):
    """Tests yosys.read, run, abc and the command line."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.source = self.folder / "top.sv"
        self.source.write_text(SOURCE)
        self.log = self.folder / "yosys.log"

    def test_instances_with_equal_parameters_share_a_module(self):
        yosys.run(f"{yosys.read([self.source], 'top', [('Width', 3)])}\nwrite_json {self.folder}/top.json", self.log)
        modules = json.loads((self.folder / "top.json").read_text())["modules"]
        widths = {name: len(module["ports"]["a_i"]["bits"]) for name, module in modules.items()}
        self.assertEqual(widths, {"top": 3, "part$top.u_first": 3, "part$top.u_third": 1})

    def test_an_error_names_file_and_line(self):
        self.source.write_text(SOURCE.replace("~a_i", "~b_i"))
        with self.assertRaisesRegex(tools.ToolFailed, r"^yosys failed \(log: .*\): .*top\.sv:2: ERROR: .*'b_i'"):
            yosys.run(yosys.read([self.source], "top"), self.log)

    def test_a_crash_is_an_error(self):
        """If a signal ends the process that runs Yosys, ToolFailed is raised."""
        with self.assertRaisesRegex(tools.ToolFailed, "^yosys failed"):
            yosys.run("exec -- kill -SEGV $PPID", self.log)

    def test_abc(self):
        self.assertIn("UC Berkeley, ABC", yosys.abc("version", self.folder / "abc.log"))

    def test_strict_fails_at_a_warning(self):
        self.source.write_text(SOURCE.replace("assign y_o = ~a_i;", "wire undriven; assign y_o = undriven;"))
        run = [sys.executable, "-m", "synth.yosys", f"read_slang --top top {self.source}; check"]
        self.assertEqual(subprocess.run(run, capture_output=True, check=False, cwd=tools.ROOT).returncode, 0)
        self.assertEqual(subprocess.run([*run, "--strict"], capture_output=True, check=False, cwd=tools.ROOT).returncode, 1)

    def test_a_missing_package_is_named(self):
        said = io.StringIO()
        with mock.patch("importlib.util.find_spec", return_value=None), mock.patch.object(tools, "VENV", self.folder), \
                mock.patch.object(sys, "argv", ["synth.yosys", "help"]), contextlib.redirect_stderr(said):
            self.assertEqual(yosys.main(), 2)
            self.assertEqual((yosys.installed(), yosys.version()), (False, ""))
        self.assertEqual(said.getvalue(), "synth.yosys: Yosys is not installed: pip install -r synth/requirements.txt\n")

    def test_comparisons_take_no_equality(self):
        """A comparison needs the same number of gates when its operands are swapped."""
        counts = []
        for operator in ("<", ">", ">=", "<="):
            self.source.write_text(f"module top(input logic [7:0] a_i, b_i, output logic y_o); assign y_o = a_i {operator} b_i; endmodule\n")
            gates = scripts.gates("fast", [], self.folder / "out")
            yosys.run(f"{yosys.read([self.source], 'top')}\n{gates}\ntee -q -o {self.folder}/stat.json stat -json", self.log)
            counts.append(json.loads((self.folder / "stat.json").read_text())["design"]["num_cells"])
        self.assertEqual((counts[1], counts[3]), (counts[0], counts[2]))


class Memories(unittest.TestCase):
    """Tests flow `blocks`."""

    def check(self, design: catalogue.Design, depth: int, width: int, address: int, enables: int) -> None:
        """Checks that a memory's ports become the design's ports: every bit of data and address, and one enable per part of a word."""
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stderr(io.StringIO()) as said:
            root = pathlib.Path(folder)
            found, _ = mapping.synthesise(design, catalogue.library("osu035"), "blocks", root)
            (netlist,) = root.glob("*/netlist.json")
            ports = mapping.top_module(netlist)["ports"]
        bits = collections.Counter(re.sub(r"[.[].*", "", name.rpartition("words.")[2]) for name in ports if "words." in name)
        self.assertRegex(said.getvalue(), f"^mapping, minutes for a core: {folder}/.*/yosys.log\n$")
        self.assertEqual(found["blocks"]["the rest"]["bits"], width * depth)
        self.assertEqual([bits[port] for port in ("read_data_o", "write_data_i", "read_address_i", "write_enable_i")],
                         [width, width, address, enables])

    def test_every_bit_of_a_kept_memory_is_timed(self):
        """Checks a queue that contains a ram."""
        self.check(catalogue.design("fifo", Width=48, Depth=64, Memory=1), 64, 48, 6, 1)

    def test_parts_of_a_word_have_an_enable_each(self):
        """Checks a ram with several parts per word, as used for the tags of a cache's ways."""
        self.check(catalogue.design("ram", Width=48, Depth=64, Parts=4), 64, 48, 6, 4)
