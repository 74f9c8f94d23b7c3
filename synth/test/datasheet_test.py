"""Tests the table of modules, and the files generated from registers.md."""

import csv
import unittest

from synth import cores, datasheet, registers, tables


class Datasheet(unittest.TestCase):
    """Tests the reading of headers, and the pages' tables and figures."""

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

    def test_a_row_says_what_a_module_is(self):
        """A row has a short description, latency and throughput. Its figures can be read back from the page."""
        text = datasheet.page({"adder": ["64,000", "2.27", ""]})
        self.assertIn("\n|full_adder|Full adder: one bit of sum and carry|0|||||\n", text)
        self.assertIn("|fp_adder|Floating-point add and subtract|0 or, Pipelined, 3|one operation a clock||||\n", text)
        self.assertEqual(datasheet.published(text)["adder"], ["64,000", "2.27", ""])
        for core, files in datasheet.modules().items():
            for name, file in files.items():
                words = datasheet.stated(datasheet.sentences(datasheet.header(file.read_text())))[0].split()
                self.assertTrue(2 <= len(words) <= datasheet.WORDS, f"{core}/{name}: {words}")

    def test_claims_follow_from_the_tables(self):
        """Figures in the text of results/README.md follow from the published files."""
        rows = {(row["design"], row["target"], row["flow"]): row
                for row in csv.DictReader((tables.RESULTS / "synth.csv").read_text().splitlines())}
        ripple, less, more, graded = (float(rows[f"adder-{name}", "osu035", "cells"]["delay_ns"])
                                      for name in ("ripple", "uniform-12x4", "uniform-6x8", "graded"))
        layouts = {(row["design"], row["flow"]): float(row["median"])
                   for row in csv.DictReader((tables.RESULTS / "layout-adders.csv").read_text().splitlines())}
        saved = [f"{100 - 100 * layouts[f'adder-{name}', 'cells'] / layouts['adder-ripple', 'cells']:.0f}" for name in (
            "uniform-12x4", "uniform-6x8", "graded")]
        text = (tables.RESULTS / "README.md").read_text()
        for claim in (f"uniform {saved[0]}, {saved[1]} %; graded {saved[2]} %", "in `fast`: " + ", ".join(
                          f"{name} {layouts[design, 'fast']:.1f}" for name, design in (
                              ("ripple", "adder-ripple"), ("graded", "adder-graded"), ("`+`", "adder-behavioural"))),
                      f"{1 - less / ripple:.0%} (12 x 4), {1 - more / ripple:.0%} (6 x 8); graded {1 - graded / ripple:.0%}".replace("%", " %"),
                      f"{float(rows['hit_test_unit', 'osu035', 'parts']['delay_ns']):.2f} ns",
                      *(f"{name} {float(rows[f'adder-{design}', 'ice40', 'placed']['mhz']):.0f}" for name, design in (
                          ("ripple", "ripple"), ("graded", "graded"), ("uniform", "uniform-6x8"), ("`+` wins:", "behavioural")))):
            self.assertIn(claim, text)

    def test_every_folder_is_listed(self):
        """hw/README.md lists each core, links to the core's README.md if there is one, and links to modules.md."""
        text = (cores.HW / "README.md").read_text()
        self.assertIn("(modules.md)", text)
        for core in cores.names():
            has_page = (cores.HW / core / "README.md").exists()
            self.assertIn(f"|[{core}]({core}/README.md)|" if has_page else f"|{core}|", text)


class Registers(unittest.TestCase):
    """Tests the reading of hw/ray_core/registers.md. (`synth.datasheet --check` checks the generated files.)"""

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
