"""What the pages of hw/ are filled with."""

import unittest

from synth import cores, datasheet


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
        """A line a module, with its figures; columns that nobody fills are left out."""
        text = datasheet.modules("arith", {"adder": ["0.064", "2.27", ""]})
        self.assertIn("| [full_adder](full_adder.sv) | Full adder: one bit of sum and carry | Combinational |  |  |", text)
        self.assertIn("| Combinational | 0.064 | 2.27 |", text)
        self.assertNotIn("MHz", text)
        self.assertEqual(datasheet.published(text)["adder"], ["0.064", "2.27", ""])
        self.assertEqual(datasheet.published(datasheet.modules("common", {})), {})

    def test_marks(self):
        """Old text gives way to the new; what was not measured stays; an unknown mark is refused."""
        page = cores.HW / "common" / "README.md"
        new = datasheet.filled(page, "<!-- modules -->\nold\n<!-- end -->\n<!-- fpga -->\nold table\n<!-- end -->")
        self.assertIn("[fifo](fifo.sv)", new)
        self.assertNotIn("-->\nold\n", new)
        self.assertIn("old table\n<!-- end -->", new)
        self.assertEqual(datasheet.filled(page, new), new)
        with self.assertRaises(ValueError):
            datasheet.filled(page, "<!-- nonsense -->\n<!-- end -->")

    def test_every_folder_has_a_page(self):
        """Each core's page has a table of its modules, and the page of all names it."""
        text = (cores.HW / "README.md").read_text()
        for core in cores.names():
            self.assertIn("<!-- modules -->", (cores.HW / core / "README.md").read_text())
            self.assertIn(f"({core}/README.md)", text)

    def test_pages_fit_a_screen_or_two(self):
        """A page says what is here, how it fits and how to change it, not what the sources say."""
        for page in datasheet.pages():
            self.assertLess(len(page.read_text().splitlines()), 100, page)


if __name__ == "__main__":
    unittest.main()
