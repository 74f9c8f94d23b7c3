"""Tests the parsers of command lines and of the tools' reports."""

import argparse
import contextlib
import io
import sys
import unittest
from unittest import mock

from synth import catalogue, chosen, fpga, mapping, netlists, tools
from synth.catalogue import Design


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


class Options(unittest.TestCase):
    """Tests chosen.whole and chosen.whole_numbers."""

    def test_whole(self):
        """Right values are parsed, wrong values are refused."""
        for check, right, wrong in ((chosen.whole(1, 9), {"1": 1, "9": 9}, ("", "0", "10", "nan", "2.5", "x", "-1")),
                                    (chosen.whole_numbers, {"4": [4], "4,5,7": [4, 5, 7]}, ("", "abc", "4,,5", "0", "1,-1", "256"))):
            for text, value in right.items():
                self.assertEqual(check(text), value)
            for text in wrong:
                with self.assertRaises(argparse.ArgumentTypeError):
                    check(text)


class Parsing(unittest.TestCase):
    """Tests the parsers of synth.mapping."""

    def test_critical_path(self):
        """The delay is arrival plus set-up time. Steps have pins and cells."""
        delay, steps = mapping.critical_path(OPENSTA)
        self.assertEqual(delay, 0.22)
        self.assertEqual([step["pin"] for step in steps], ["a_i[0]", "_1_/A", "_1_/Y", "_2_/D"])
        self.assertEqual(steps[2]["delay"], 0.12)

    def test_registers(self):
        """An end of a path is the signal of a register, or a port."""
        netlist = "DFFPOSX1 _2_ (\n .CLK(clk_i),\n .D(n1),\n .Q(\\u_core.sum_q[3] )\n);\n"
        self.assertEqual(mapping.registers(netlist, [{"pin": "bus_i[0]"}, {"pin": "_2_/D"}]),
                         {"from": "bus_i[0]", "to": "u_core.sum_q[3]"})

    def test_no_path(self):
        """A design that was not timed is a failure, not 0 ns."""
        with self.assertRaises(tools.ToolFailed):
            mapping.critical_path("Error: netlist.v, line 3 syntax error\nNo paths found.\n")


# Yosys's form: the area of a module includes its submodules.
STAT = {
    "line_cache$ray_core.u_memory.u_cache": {"area": 100.0, "num_cells_by_type": {"DFFPOSX1": 10}},
    "memory_subsystem$ray_core.u_memory": {
        "area": 230.5, "num_cells_by_type": {"line_cache$ray_core.u_memory.u_cache": 2, "NAND2X1": 3}},
    "primitive_fetch$ray_core.u_add.gen_part[0].u_part": {"area": 50.0, "num_cells_by_type": {"NAND2X1": 5}},
    "vec_add$ray_core.u_add": {"area": 150.0, "num_cells_by_type": {"primitive_fetch$ray_core.u_add.gen_part[0].u_part": 3}},
    "ray_core": {"area": 618.0, "num_cells_by_type": {
        "memory_subsystem$ray_core.u_memory": 2, "vec_add$ray_core.u_add": 1, "kept_memory": 1}}}
DUMP = r"""
module \line_cache$ray_core.u_memory.u_cache
  cell \kept_memory \words
    parameter \BITS 4096
  end
  cell \kept_memory \labels
    parameter \BITS 2048
  end
end
module \ray_core
  cell \kept_memory \origins
    parameter \BITS 6144
  end
end
"""


class Blocks(unittest.TestCase):
    """Tests mapping.block_costs and mapping.kept_memories."""

    def test_blocks_count_what_is_in_them(self):
        memories = mapping.kept_memories(DUMP)
        self.assertEqual(memories, {"line_cache$ray_core.u_memory.u_cache": 6144, "ray_core": 6144})
        self.assertEqual(mapping.block_costs(STAT, memories), {
            "the rest": {"count": 1, "area": 7, "bits": 6144},
            "memory_subsystem": {"count": 2, "area": 461, "bits": 4 * 6144}, "vec_add": {"count": 1, "area": 150, "bits": 0}})

    def test_a_dump_of_one_module_names_none(self):
        text = "  cell \\kept_memory \\words\n    parameter \\BITS 40\n  end\n"
        self.assertEqual(mapping.kept_memories(text), {"": 40})


class Wrappers(unittest.TestCase):
    """Tests the Verilog wrapper of a design."""

    PORTS = {"a_i": {"direction": "input", "bits": [2, 3]}, "b_o": {"direction": "output", "bits": [4]}}

    def test_the_slowest_path_between_registers(self):
        steps = [("clk-to-q", 0.5, "u_a.sum_q_TRELLIS_FF_Q_5", "u_a.sum_q_TRELLIS_FF_Q_5"), ("routing", 1.5, "u_a.sum_q_TRELLIS_FF_Q_5", "l"),
                 ("logic", 0.25, "l", "l"), ("routing", 1, "l", "u_b.norm_q_TRELLIS_FF_Q"), ("setup", 0.25, "", "u_b.norm_q_TRELLIS_FF_Q")]
        path = [{"type": kind, "delay": delay, "from": {"cell": a}, "to": {"cell": b}} for kind, delay, a, b in steps]
        found = fpga.slowest_path([{"from": "<async>", "to": "posedge clk", "path": []},
                                   {"from": "posedge clk", "to": "posedge clk", "path": path}])
        self.assertEqual(found, {"from": "u_a.sum_q", "to": "u_b.norm_q", "logic": 1.0, "wires": 2.5})

    def test_clocks_a_test_are_those_of_the_headers(self):
        self.assertEqual([fpga.period(top) for top in ("hit_test_unit", "general_hit_test_unit", "hit_test_pipeline")], [7, 10, 1])

    def test_registered(self):
        """All inputs and outputs get registers."""
        ports = fpga.port_widths("d", {"modules": {"d": {"ports": self.PORTS}}})
        self.assertEqual(ports, [("input", "a_i", 2), ("output", "b_o", 1)])
        text = fpga.registered(Design("d", "d", "fp", clock="clk_i"), [("input", "clk_i", 1), *ports])  # its clock is the registers'
        self.assertIn(".clk_i(clk_i)", text)
        self.assertIn("reg [1:0] in;", text)
        self.assertIn(".a_i(in[0 +: 2])", text)
        self.assertIn(".b_o(result[0 +: 1])", text)

    def test_twins(self):
        """RTL and netlist get the same vector of inputs."""
        text = netlists.twins(Design("d", "d", "arith"), self.PORTS)
        self.assertIn("d #() u_rtl (.a_i(in_i[0 +: 2]), .b_o(rtl_b_o));", text)
        self.assertIn("netlist u_netlist (.a_i(in_i[0 +: 2]), .b_o(netlist_b_o));", text)


def design(*words: str) -> catalogue.Design:
    """Returns the design that `make synth TOP=... ...` describes."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--top")
    chosen.add_arguments(parser)
    with mock.patch.object(sys, "argv", ["synth", *words]):
        return chosen.design(chosen.parse(parser))


class Chosen(unittest.TestCase):
    def test_names_are_those_of_the_report(self) -> None:
        reported = {row.design.name: row.design for row in catalogue.report_rows()}
        for kind in ("ripple", "graded", "prefix"):
            with self.subTest(kind):
                given = design("--top=adder", f"--adder={kind}", "--width=48")
                self.assertEqual(dict(given.parameters), dict(reported[f"adder-{kind}"].parameters))
        ahead = design("--top=adder", "--adder=graded", "--width=48", "--look-ahead=1")
        self.assertEqual(dict(ahead.parameters), dict(reported["adder-graded-look-ahead"].parameters))
        self.assertIn("look_ahead", ahead.name)

    def test_a_file_of_the_user_replaces_the_prefix_adder(self) -> None:
        given = argparse.Namespace(adder="host/lab/exercises/kogge_stone_adder.sv")
        with chosen.replaced(given):
            mine = design("--top=adder", f"--adder={given.adder}", "--width=24")
            self.assertIn("kogge_stone_adder", "".join(file.read_text() for file in mine.sources()))
        self.assertEqual(mine.name, "adder-kogge_stone_adder-Width24")
        self.assertNotIn("kogge_stone_adder", "".join(file.read_text() for file in mine.sources()))

    def test_groups_of_a_multiplier_are_as_in_the_rtl(self) -> None:
        self.assertNotIn("LookAhead", dict(design("--top=booth_multiplier", "--adder=graded").parameters))

    def test_parameters_that_a_module_cannot_have(self) -> None:
        for words, said in (("--top=fp_adder --groups=4,5", "fp_adder: found parameter GroupWidths, expected one of ExpWidth, FracWidth, Arith"),
                            ("--top=fp_adder --exp-width=4", r"fp_adder: found ExpWidth=4 and FracWidth=23, expected 2 <= FracWidth <= 2\^"),
                            ("--top=booth_multiplier --width=1", "booth_multiplier: found Width=1, expected at least 2 and at most 4080")):
            with self.subTest(words), self.assertRaisesRegex(ValueError, said):
                design(*words.split())
        for name, value, said in (("Width", "0", "expected at least 1"), ("Width", "-3", "expected a whole number"), ("Width", "", "expected a whole"),
                                  ("Depth", "2", "found parameter Depth, expected one of Width, Arith, GroupWidths, LookAhead")):
            with self.subTest(name, value=value), self.assertRaisesRegex(ValueError, f"^adder: .*{said}"):
                catalogue.design("adder", **{name: value})

    def test_a_wrong_value_is_told_in_one_line(self) -> None:
        said = io.StringIO()
        with contextlib.redirect_stderr(said), self.assertRaises(SystemExit) as ended:
            design("--top=fp_adder", "--frac-width=1")
        self.assertEqual((ended.exception.code, said.getvalue().count("\n")), (2, 1))
        self.assertRegex(said.getvalue(), "--frac-width: expected a whole number from 2 to 112, got '1'")
