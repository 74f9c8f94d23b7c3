"""The table of modules, and what is made of the registers' page."""

import unittest

from synth import catalogue, cores, datasheet, registers


class Datasheet(unittest.TestCase):
    """Pieces of headers, tables, and marks."""

    HEADER = """// What it is, I . N being
// a product. Combinational;
// one level.
//
// Latency 2 clocks.
module m;
"""

    def test_sentences(self):
        """A sentence ends at a full stop that follows a word, and at the end of a paragraph."""
        self.assertEqual(datasheet.sentences(datasheet.header(self.HEADER)),
                         ["What it is, I . N being a product", "Combinational; one level", "Latency 2 clocks"])

    def test_modules(self):
        """A line a module, with its figures."""
        text = datasheet.modules({"adder": ["0.064", "2.27", ""]})
        self.assertIn("arith,full_adder,Full adder: one bit of sum and carry,Combinational,,,\n", text)
        self.assertIn("Combinational,0.064,2.27,\n", text)
        found = datasheet.published(text)
        self.assertEqual(found["adder"], ["0.064", "2.27", ""])
        modules = {file.stem for core in cores.names() for file in cores.files(core) if not file.stem.endswith("_pkg")}
        self.assertEqual(modules ^ found.keys(), set())

    def test_figures_are_of_adders_that_units_have(self):
        """Their groups add by look-ahead."""
        ripple = {row.design.name for row in catalogue.report_rows() if dict(row.design.parameters).get("LookAhead") == "1'b0"}
        self.assertEqual(ripple & datasheet.SHOWN.keys(), set())
        self.assertTrue(ripple)
        self.assertEqual(set(datasheet.SHOWN) - {row.design.name for row in catalogue.report_rows()}, set())

    def test_every_folder_is_listed(self):
        """The page of all names each core, with its page where it has one, and the table of modules."""
        text = (cores.HW / "README.md").read_text()
        self.assertIn("(modules.csv)", text)
        for core in cores.names():
            has_page = (cores.HW / core / "README.md").exists()
            self.assertIn(f"| [{core}]({core}/README.md) |" if has_page else f"| {core} |", text)


class Registers(unittest.TestCase):
    """hw/ray_core/registers.md. That the made files are up to date: `synth.datasheet --check`."""

    def setUp(self):
        self.text = registers.PAGE.read_text()

    def test_a_changed_row_changes_what_is_made(self):
        before = registers.made(self.text)
        for old, new in (("| 1 | `error_line`", "| 1 | `wrong_line`"), ("`flags` | 3 |", "`flags` | 9 |"),
                         ("0x0fffffff", "0x0000ffff")):
            self.assertIn(old, self.text)
            after = registers.made(self.text.replace(old, new))
            self.assertTrue(any(after[file] != before[file] for file in before), old)

    def test_what_makes_no_sense_is_refused(self):
        for old, new in (("| 0x018 |", "| 0x014 |"), ("| 0x018 |", "| 0x01a |"), ("| `base` | idle |", "| `base` | often |"),
                         ("`flags` | 3 |", "`flags` | 2 |"), ("`flags` | 3 |", "`flag` | 3 |"), ("| idle | 0x0fffffff |", "| idle | |")):
            self.assertIn(old, self.text)
            with self.assertRaises(ValueError, msg=new):
                registers.made(self.text.replace(old, new))

    def test_counters_are_events_in_their_order(self):
        counters = next(register for register in registers.registers(self.text) if register.name == "counters")
        package = (cores.HW / "ray_core" / "ray_core_pkg.sv").read_text()
        self.assertEqual(counters.words, 2 * len(counters.bits))
        for name, number in list(counters.bits.items())[1:]:
            self.assertRegex(package, rf"Event{''.join(part.capitalize() for part in name.split('_'))} += 4'd{number - 1}\b")
