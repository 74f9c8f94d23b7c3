"""Tests the parser of Liberty files, and a user's library in the flows."""

import contextlib
import io
import pathlib
import tempfile
import unittest
from unittest import mock

from synth import __main__ as program
from synth import catalogue, liberty, mapping, store

# A library in femtofarads and picoseconds, with only the cells that ABC needs, and a register.
TABLE = 'values ("10, 100", "20, 110");'
SLEWS = 'index_1 ("10, 100"); index_2 ("1, 100");'


def cell(name: str, area: float, farads: float, function: str, inputs: str) -> str:
    """Returns a gate with the same timing table for all arcs."""
    arcs = "".join(f"timing () {{ related_pin : {pin}; timing_sense : {'negative' if function[0] in '!(' else 'positive'}_unate; " + "".join(
        f"{kind} (t) {{ {SLEWS} {TABLE} }} " for kind in ("cell_rise", "cell_fall", "rise_transition", "fall_transition")) + "}\n"
        for pin in inputs)
    pins = "".join(f"pin ({pin}) {{ direction : input; capacitance : {farads}; }}\n" for pin in inputs)
    return f'cell ({name}) {{ area : {area};\n{pins}pin (Y) {{ direction : output; function : "{function}";\n{arcs}}}\n}}\n'


LIBRARY = ("library (small) { /* of a test */\n  time_unit : \"1ps\"\n  capacitive_load_unit (1, ff);\n  voltage_unit : \"1V\";\n"
           "  current_unit : \"1uA\"; pulling_resistance_unit : \"1kohm\"; leakage_power_unit : \"1nW\";\n"
           "  nom_process : 1; nom_temperature : 25; nom_voltage : 1.1;\n  delay_model : table_lookup;\n"
           "  lu_table_template (t) { variable_1 : input_net_transition; variable_2 : total_output_net_capacitance;\n"
           f"    {SLEWS} }}\n"
           + cell("inv_1", 1, 2.0, "!A", "A") + cell("inv_4", 2, 7.5, "(A)'", "A") + cell("nand_1", 1.5, 2.0, "!(A B)", "AB") + cell("buf_1", 1.2, 2.0, "A", "A") + cell("nor_1", 1.5, 2.0, "!(A+B)", "AB")
           + cell("PADOUT", 1, 0.1, "A", "A") + "}\n")


class Reading(unittest.TestCase):
    """Tests liberty.parse."""

    def test_units_without_semicolons_comments_and_tables(self):
        found = liberty.parse(LIBRARY, "small.lib")
        self.assertEqual((found.name, found.attributes["time_unit"], found.number("nom_voltage")), ("small", "1ps", 1.1))
        self.assertEqual(liberty.inverters(found), [(2.0, "inv_1"), (7.5, "inv_4")])
        (arc,) = [arc for pin in next(found.of("cell")).of("pin") for arc in pin.of("timing")]
        self.assertEqual(next(arc.of("cell_rise")).attributes["values"], '"10, 100" , "20, 110"')

    def test_a_fault_is_told_with_its_line(self):
        for text, said in (("library (x) {\n cell (y) {\n}\n", "x.lib:4: found the end of the file, expected } of library"),
                           ("library (x) {\n}\n}\n", "x.lib:3: found }, expected a group"),
                           ("library {\n}\n", "x.lib:1: found {, expected it after"), ("cell (x) {\n}\n", "x.lib:1: found 0 groups")):
            with self.subTest(said), self.assertRaisesRegex(ValueError, said):
                liberty.parse(text, "x.lib")

    def test_pads_are_left_out(self):
        self.assertEqual([cell.name for cell in liberty.parse(catalogue.without_pads(LIBRARY, "x"), "x").of("cell")],
                         ["inv_1", "inv_4", "nand_1", "buf_1", "nor_1"])


class OfUser(unittest.TestCase):
    """Tests LIBERTY=FILE."""

    def measured(self, text: str, flow: str) -> tuple[catalogue.Library, dict]:
        """Returns the library in `text`, and the result for a 4-bit ripple adder mapped to this library."""
        with tempfile.TemporaryDirectory() as name, mock.patch.object(store, "OUT", pathlib.Path(name)):
            file = pathlib.Path(name) / "my cells.lib"
            file.write_text(text)
            library = catalogue.of_user(file)
            return library, mapping.synthesise(catalogue.design("adder", adder="ripple", Width=4), library, flow)[0]

    def test_driver_load_and_units_are_the_files(self):
        library, got = self.measured(LIBRARY, "fast")
        self.assertEqual((library.name, library.title, library.driver), ("user-my-cells", "my cells.lib", "inv_4"))
        self.assertAlmostEqual(library.load_pf, 0.016)
        self.assertEqual(set(got["cells"]) - {"inv_1", "inv_4", "nand_1", "buf_1", "nor_1"}, set())
        steps = len({step["pin"].partition("/")[0] for step in got["path"]}) - 2  # without the two ports
        self.assertGreater(steps, 4)
        self.assertTrue(0.01 * steps < got["delay_ns"] < 0.11 * (steps + 1))  # a gate takes 10 to 110 ps

    def test_osu_under_another_name(self):
        """The same cells have the same area and nearly the same delay. Delays differ because the load is 0.107 pF instead of 0.1."""
        osu = catalogue.library("osu035")
        text = osu._file("lib").read_text()
        for flow in ("cells", "fast", "area"):
            with self.subTest(flow):
                library, got = self.measured(text, flow)
                with tempfile.TemporaryDirectory() as name, mock.patch.object(store, "OUT", pathlib.Path(name)):
                    same, _ = mapping.synthesise(catalogue.design("adder", adder="ripple", Width=4), osu, flow)
                self.assertEqual((library.driver, got["area"]), ("INVX4", same["area"]))
                self.assertAlmostEqual(got["delay_ns"] / same["delay_ns"], 1, delta=0.02)

    def test_the_command_line(self):
        """Measures one design. The report's rows have only flows for which the library has the cells."""
        said, libraries = io.StringIO(), list(catalogue.LIBRARIES)
        with (tempfile.TemporaryDirectory() as name, mock.patch.object(store, "OUT", pathlib.Path(name)),
              mock.patch.object(catalogue, "LIBRARIES", libraries), contextlib.redirect_stdout(said)):
            file = pathlib.Path(name) / "mine.lib"
            file.write_text(LIBRARY)
            with mock.patch("sys.argv", ["synth", "--liberty", str(file), "--top", "leading_zero_counter", "--width", "4"]):
                self.assertEqual(program.main(), 0)
            (row,) = [row for row in catalogue.report_rows() if row.design.name == "adder-ripple"]
            self.assertEqual(row.flows_on(libraries[-1]), ("kept", "default", "fast"))
        self.assertRegex(said.getvalue(), r"mine\.lib: um2 / ns +\| +area \| +small \| +fast \|\n.*\n\| leading_zero_counter-Width4 +(\| +\d+ / 0\.\d\d ){3}\|")

    def test_what_is_no_library(self):
        for text, said in (("library (x) {\n}\n", "found 0 inverters and no capacitive_load_unit"), ("library (x) {\n", "x.lib:2: found the end"),
                           (None, "found no such file, expected a Liberty file")):
            with self.subTest(said), tempfile.TemporaryDirectory() as name:
                file = pathlib.Path(name) / "x.lib"
                if text is not None:
                    file.write_text(text)
                libraries = list(catalogue.LIBRARIES)
                with (mock.patch("sys.argv", ["synth", "--liberty", str(file)]), mock.patch.object(catalogue, "LIBRARIES", libraries),
                      contextlib.redirect_stderr(io.StringIO()) as error):
                    self.assertEqual(program.main(), 2)
                self.assertRegex(error.getvalue(), f"^synth: .*{said}")
                self.assertEqual(error.getvalue().count("\n"), 1)
