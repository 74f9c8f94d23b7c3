"""What the pages of hw/ are filled with."""

import unittest

from synth import catalogue, cores, datasheet


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

    def test_every_folder_has_a_page(self):
        """The page of all names each core's page, and each core's page the table of modules."""
        text = (cores.HW / "README.md").read_text()
        for core in cores.names():
            self.assertIn("(../modules.csv)", (cores.HW / core / "README.md").read_text())
            self.assertIn(f"({core}/README.md)", text)

    def test_pages_fit_a_screen_or_two(self):
        """A page says what is here, how it fits and how to change it, not what the sources say."""
        for page in cores.HW.glob("**/README.md"):
            self.assertLess(len(page.read_text().splitlines()), 100, page)


if __name__ == "__main__":
    unittest.main()
