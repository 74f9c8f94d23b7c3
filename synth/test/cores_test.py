"""Tests synth.cores, which reads the lists of files hw/*/*.core."""

import pathlib
import tempfile
import unittest

from synth import board, catalogue, cores, scripts, tools, verilog, yosys


class Cores(unittest.TestCase):
    """Two cores in a folder of their own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.hw = pathlib.Path(folder.name)
        self.write("fp", ["fp_adder.sv", "fp_pkg.sv"], ["arith"])
        self.write("arith", ["adder.sv"], [])

    def write(self, core, files, depends):
        """Writes a core and its files."""
        (self.hw / core).mkdir()
        lines = ["CAPI=2:", *(f"      - {name}" for name in files), *(f"      - raygate:hw:{name}" for name in depends)]
        (self.hw / core / f"{core}.core").write_text("\n".join(lines) + "\n")
        for name in files:
            (self.hw / core / name).touch()

    def test_order(self):
        """The cores that a core uses come first. Within a core, packages come first."""
        self.assertEqual([file.name for file in cores.files("fp", self.hw)], ["adder.sv", "fp_pkg.sv", "fp_adder.sv"])
        self.assertEqual(cores.names(self.hw), ["arith", "fp"])

    def test_used(self):
        """Finds the modules that a module names outside comments, directly or indirectly."""
        (self.hw / "fp" / "fp_adder.sv").write_text("module fp_adder; fp_pkg::x; // adder\n")
        among = cores.files("fp", self.hw)
        self.assertEqual([file.stem for file in cores.used("fp_adder", among)], ["fp_pkg", "fp_adder"])
        (self.hw / "fp" / "fp_pkg.sv").write_text("adder u_adder ();\n")
        self.assertEqual(cores.used("fp_adder", among), among)

    def test_list_and_folder_disagree(self):
        """Reports an unlisted file, a missing file, and a missing list."""
        for change, said in [(lambda: (self.hw / "arith" / "new.sv").touch(), r"arith\.core: new\.sv is unlisted, expected a line"),
                             (lambda: (self.hw / "fp" / "fp_pkg.sv").unlink(),
                              r"fp\.core: fp_pkg\.sv is listed, expected the file"),
                             (lambda: (self.hw / "arith" / "arith.core").unlink(), r"arith\.core: not found")]:
            change()
            with self.assertRaisesRegex(ValueError, said):
                cores.files("fp", self.hw)
            if (self.hw / "arith" / "new.sv").exists():
                (self.hw / "arith" / "new.sv").unlink()

    def test_plain_verilog_takes_parameters_of_any_module(self) -> None:
        """Also writes modules with an unsized constant at a cell's port. A failed run leaves no file."""
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "exact_unit.v"
            verilog.write(catalogue.design("exact_unit", DigitWidth=24), out)
            tools.run([tools.find("verilator"), "--lint-only", "--top-module", "exact_unit", out], out.with_suffix(".log"))
            with self.assertRaises(tools.ToolFailed):
                verilog.write(catalogue.design("exact_unit", DigitWidth=1), out)
            self.assertFalse(out.exists())

    def test_boards_elaborate(self) -> None:
        """Elaborates each board with the cells of its FPGA."""
        for each in board.BOARDS:
            with self.subTest(each.name), tempfile.TemporaryDirectory() as folder:
                yosys.run(scripts.elaborated(each), pathlib.Path(folder) / "yosys.log")
