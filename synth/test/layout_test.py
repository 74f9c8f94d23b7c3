"""Tests layouts: the readers of LEF, DEF and magic's files, and one adder from netlist to delay with wires."""

import pathlib
import tempfile
import unittest
from unittest import mock

from synth import catalogue, mapping, store, tools, yosys
from synth.layout import __main__ as command
from synth.layout import estimate, flow, lef, netlist, parasitics, picture, place, route
from synth.layout.lef import Layer, Rect, Technology
from synth.layout.netlist import Cell, Netlist, Port
from synth.layout.route import Wire

LAYERS = {"metal1": Layer(2, 1, 0.6, 0.07, False), "metal2": Layer(1.6, 0.8, 0.6, 0.07, True),
          "metal3": Layer(2, 1, 0.6, 0.07, False)}
TECHNOLOGY = Technology(LAYERS, {"INVX1": lef.Macro(4.8, 20, {"A": [], "Y": []})})

LEF = """\
LAYER metal1
  TYPE		ROUTING ;
  DIRECTION	HORIZONTAL ;
  PITCH		2  ;
  OFFSET	1  ;
  WIDTH		0.6 ;
  RESISTANCE	RPERSQ 0.07 ;
END metal1
MACRO INVX1
  SIZE 4.800 BY 20.000 ;
  PIN A
    DIRECTION INPUT ;
    PORT
      LAYER metal1 ;
        RECT 0.400 6.800 1.200 7.600 ;
    END
  END A
  PIN gnd
    USE GROUND ;
    PORT
      LAYER metal1 ;
        RECT -0.400 -0.600 5.200 0.600 ;
    END
  END gnd
END INVX1
"""

ROUTED = """\
UNITS DISTANCE MICRONS 100 ;
NETS 2 ;
- n1
  ( c0 Y )
  ( c1 A )

+ ROUTED metal1 ( 160 400 ) M2_M1 
  NEW metal2 ( 160 400 ) ( * 800 ) M3_M2 
  NEW metal3 ( 160 800 ) ( 480 * ) ;
- n2
  ( c1 Y )
;
END NETS
"""


class Reading(unittest.TestCase):
    """Tests the readers of the tools' files."""

    def test_lef(self):
        """Reads a cell's size and signal pins, without rails."""
        with tempfile.TemporaryDirectory() as name:
            file = pathlib.Path(name) / "tiny.lef"
            file.write_text(LEF)
            found = lef.read(file)
            self.assertEqual(found.layers, {"metal1": LAYERS["metal1"]})
            self.assertEqual(found.macros["INVX1"], lef.Macro(4.8, 20, {"A": [Rect("metal1", 0.4, 6.8, 1.2, 7.6)]}))
            file.write_text("VERSION 5.4 ;\n")
            with self.assertRaisesRegex(ValueError, "0 routing layers and 0 cells"):
                lef.read(file)

    def test_routed(self):
        """Reads wires with vias, in um; a net without wires has none."""
        self.assertEqual(route.wires(ROUTED, list(LAYERS)), {"n2": [], "n1": [
            Wire("metal1", 1.6, 4, 1.6, 4, "metal2"), Wire("metal2", 1.6, 4, 1.6, 8),
            Wire("metal2", 1.6, 8, 1.6, 8, "metal3"), Wire("metal3", 1.6, 8, 4.8, 8)]})

    def test_capacitances(self):
        """Counts capacitance to ground and to neighbours, without the capacitance of a cell's pin."""
        text = ('scale 1000 1 5\nnode "n1" 2 1000 0 0 m2\nnode "c0/A" 2 9 0 0 m1\n'
                'cap "n1" "n2" 500\nmerge "c0/A" "n1" -70\n')
        found = parasitics.capacitances(text, {"n1", "n2"})
        self.assertAlmostEqual(found["n1"], 0.0015)
        self.assertAlmostEqual(found["n2"], 0.0005)

    def test_gaps(self):
        """Full rows have no gaps. Otherwise gaps take the free space, most of it beside narrow cells with many pins."""
        wide = {"c0": Cell("a", "WIDE", {"A": "p0", "Y": "n1"})}
        narrow = {f"c{place}": Cell("b", "NARROW", dict.fromkeys("ABCY", "n1")) for place in range(1, 9)}
        technology = Technology(LAYERS, {"WIDE": lef.Macro(48, 20, {}), "NARROW": lef.Macro(8, 20, {})})
        nets = Netlist("top", wide | narrow, {})
        self.assertEqual(sum(place.gaps(nets, technology, 1.0, 1.6).values()), 0)
        found = place.gaps(nets, technology, 0.5, 1.6)
        self.assertEqual(found["c0"], 0)
        self.assertAlmostEqual(sum(found.values()), 48 + 8 * 8, delta=1.6)


class Trees(unittest.TestCase):
    """Tests the resistors of a net."""

    TAPS = {"c0:Y": [Rect("metal1", 1.4, 3.8, 1.8, 4.2)], "c1:A": [Rect("metal3", 4.6, 7.8, 5, 8.2)]}

    def ohms(self, wires: list[Wire]) -> float:
        """Returns the sum of a net's resistors. All resistors of the net must be in series."""
        found = parasitics.tree(wires, self.TAPS, TECHNOLOGY, {"metal1": 1.3, "metal2": 1.2})
        return sum(value for _, _, value in found.resistors if value > 0.01)

    def test_series(self):
        """Adds sheet resistance times length over width, and contact resistances."""
        wires = route.wires(ROUTED, list(LAYERS))["n1"]
        self.assertAlmostEqual(self.ohms(wires), 1.3 + 1.2 + 0.07 * 7.2 / 0.6)
        with self.assertRaisesRegex(tools.ToolFailed, "2 pieces"):
            self.ohms([wire for wire in wires if wire.to != "metal3"])

    def test_turned(self):
        """Orientation S turns the metal of a cell by 180 degrees."""
        self.assertEqual(parasitics.turned(Rect("metal1", 1, 2, 3, 4), (10, 20), (100, 200), "S"),
                         Rect("metal1", 107, 216, 109, 218))


class Estimate(unittest.TestCase):
    """Tests estimated wires."""

    def test_tree(self):
        """A new point joins the nearest point of the tree, not the first."""
        self.assertEqual(estimate.tree([(0, 0), (10, 0), (12, 1), (0, 3)]), [(0, 3), (0, 1), (1, 2)])

    def test_wires(self):
        """Wires connect all pins, vertically in metal 2 and horizontally in metal 3. A net with one pin has no wires."""
        technology = Technology(LAYERS, {"INVX1": lef.Macro(4.8, 20, {
            "A": [Rect("metal1", 0.4, 6, 1.2, 8)], "Y": [Rect("metal1", 2, 6, 2.8, 8)]})})
        nets = Netlist("top", {"c0": Cell("a", "INVX1", {"A": "p0", "Y": "n1"}), "c1": Cell("b", "INVX1", {"A": "n1", "Y": "n2"})},
                       {"p0": Port("a_i", False, "p0")})
        placed = place.Placement(nets, technology, {"c0": place.Site(0, 0, "N"), "c1": place.Site(8, 20, "FS")}, {}, 16, 40)
        placed.__dict__["pins"] = {"p0": (-0.8, 8.0, "metal3")}
        found = estimate.wires(placed)
        self.assertEqual(set(found), {"p0", "n1"})
        # Y at 2.4 + 0.8, 7 + 1; A in the row above, upside down, at 8 + 1.6, 20 + 13 + 1.
        self.assertAlmostEqual(sum(wire.length for wire in found["n1"]), 6.4 + 26)
        self.assertAlmostEqual(sum(wire.length for wire in found["p0"]), 2.4)
        for net, ends in (("n1", [("c0", "Y"), ("c1", "A")]), ("p0", [("PIN", "p0"), ("c0", "A")])):
            parasitics.tree(found[net], parasitics.taps(placed, ends), technology, {"metal1": 1.3, "metal2": 1.2})


class Parts(unittest.TestCase):
    """Tests picture.parts_of."""

    def test_bits(self):
        """A cell of an adder belongs to the highest operand bit that it depends on."""
        nets = Netlist("adder", {"c0": Cell("x", "INVX1", {"A": "p2", "Y": "n1"}),
                                 "c1": Cell("y", "NAND2X1", {"A": "n1", "B": "p0", "Y": "p3"}),
                                 "c2": Cell("z", "INVX1", {"A": "p0", "Y": "n2"})},
                       {"p0": Port("a_i[0]", False, "p0"), "p1": Port("a_i[1]", False, "p1"),
                        "p2": Port("a_i[9]", False, "p2"), "p3": Port("sum_o[0]", True, "p3")})
        found = picture.parts_of(catalogue.design("adder", adder="ripple"), nets, {"INVX1": {"Y"}, "NAND2X1": {"Y"}})
        self.assertEqual(found, {"c2": "bits 0 to 7", "c0": "bits 8 to 15", "c1": "bits 8 to 15"})

    def test_names(self):
        """Another design's cells belong to the instance that they are in."""
        names = ["u_tree.gen_adder[0].u_adder.u_cell", "$flatten\\u_last_adder.\\u_adder.$1", "$abc$1$auto$2"]
        nets = Netlist("top", {f"c{place}": Cell(name, "INVX1", {}) for place, name in enumerate(names)}, {})
        self.assertEqual(picture.parts_of(catalogue.design("booth_multiplier"), nets, {}), {
            "c1": "last adder", "c0": "tree", "c2": "the rest"})


class Report(unittest.TestCase):
    """Tests the tables of make layout."""

    RECORD = {"job": flow.Job(catalogue.Design("d", "d", "arith"), catalogue.library("osu035"), "fast"), "cells": 2, "area": 100, "core": 200, "wire_um": 1500, "wire_pf": 0.1,
              "cells_ns": 2.0, "guess_ns": 2.8}

    def test_table(self):
        """Shows least, median and greatest delay, and a ratio to the delay without wires. For failed nets, shows their number instead."""
        routed = {**self.RECORD, "wires_ns": 3.0, "spread": [2.9, 3.0, 3.2], "failed": [0, 0, 0]}
        failed = {**self.RECORD, "spread": [], "failed": [7]}
        placed = {**failed, "failed": [None]}
        rows = command.table([routed, failed, placed])
        self.assertEqual(rows[0][5:], ["0.50", "1.5", "0.10", "2.00", "2.80", "2.90", "3.00", "3.20", "1.500", "0 0 0"])
        self.assertEqual(rows[1][8:], ["2.00", "2.80", "-", "-", "-", "-", "7"])
        self.assertEqual(rows[2][-1], "not routed")


@unittest.skipUnless(yosys.installed() and all(map(tools.installed, ("coloquinte", "qrouter", "magic", "sta"))),
                     ".ci/setup layout installs the tools")
class Adder(unittest.TestCase):
    """Tests an 8-bit ripple adder, from RTL to its delay with wires."""

    def test_laid_out(self):
        """All nets are routed. Wires increase the delay, but only a little, because the adder is small."""
        design = catalogue.design("adder", adder="ripple", Width=8)
        with (tempfile.TemporaryDirectory() as name, mock.patch.object(store, "OUT", pathlib.Path(name))):
            job = flow.Job(design, catalogue.library("osu035"), "cells")
            got, _ = flow.make(job)
            self.assertEqual((got["cells"], got["failed"]), (8, 0))
            self.assertGreater(got["wires_ns"], got["cells_ns"])
            self.assertLess(got["wires_ns"], 1.1 * got["cells_ns"])
            self.assertAlmostEqual(got["guess_ns"] / got["wires_ns"], 1, delta=0.02)
            self.assertGreater(got["wire_um"], 300)
            _, wires = flow.load(job)
            self.assertTrue(all(pieces for net, pieces in wires.items() if net not in route.RAILS))
            self.assertTrue((job.folder / "adder.gds").stat().st_size > 10000)


@unittest.skipUnless(yosys.installed() and all(map(tools.installed, ("coloquinte", "sta"))), ".ci/setup layout installs the tools")
class Placement(unittest.TestCase):
    """Tests the placement of a 16-bit adder by Coloquinte."""

    def test_placed(self):
        """Cells do not overlap within rows, ports lie around the core, and the density is the requested one."""
        library = catalogue.library("osu035")
        design = catalogue.design("adder", adder="prefix", Width=16)
        with (tempfile.TemporaryDirectory() as name, mock.patch.object(store, "OUT", pathlib.Path(name))):
            mapping.synthesise(design, library, "fast")
            (run,) = (store.OUT / "runs").iterdir()
            nets = netlist.parse(mapping.top_module(run / "netlist.json"), "adder")
            technology = lef.read(library.lef)
            placed, again = (place.place(nets, technology, 1, 0.6, 1.0, pathlib.Path(name)) for _ in range(2))
        self.assertEqual(placed, again)
        rows = {}
        for cell, site in placed.cells.items():
            width = technology.macros[nets.cells[cell].kind].width
            rows.setdefault(site.y, []).append((site.x, site.x + width))
            self.assertEqual(site.turned in ("FS", "S"), round(site.y / 20) % 2 == 1)
            self.assertTrue(0 <= site.x and site.x + width <= placed.width + 1e-6)
        for row in rows.values():
            for (_, end), (start, _) in zip(sorted(row), sorted(row)[1:]):
                self.assertLessEqual(end, start + 1e-6)
        cells = sum(technology.macros[cell.kind].width * 20 for cell in nets.cells.values())
        self.assertAlmostEqual(cells / (placed.width * placed.height), 0.6, delta=0.06)
        self.assertEqual(set(placed.ports), {name for name, port in nets.ports.items() if port.net == name})
        for x, y in placed.ports.values():
            self.assertTrue(x in (0, placed.width) or y in (0, placed.height))
