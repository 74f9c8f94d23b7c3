"""What hw/README.md is filled with."""

import unittest

from synth import cores, datasheet


class Datasheet(unittest.TestCase):
    """Pieces of headers, and marks."""

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

    def test_declaration(self):
        """The header and the ports, word for word."""
        text = datasheet.declaration("hit_test_unit")
        self.assertIn("// The paper's hit-test unit:", text)
        self.assertIn("  output logic             valid_o\n);\n```", text)

    def test_marks(self):
        """Old text gives way to the new; what was not measured stays; an unknown mark is refused."""
        old = "<!-- declaration full_adder -->\nold\n<!-- end -->\n<!-- figures -->\nold figures\n<!-- end -->"
        new = datasheet.filled(old, measured=False)
        self.assertIn("module full_adder", new)
        self.assertNotIn("-->\nold\n", new)
        self.assertIn("old figures\n<!-- end -->", new)
        self.assertEqual(datasheet.filled(new, measured=False), new)
        for wrong in ("nonsense", "declaration nothing", "lines hw/fp/fp_pkg.sv | nothing at all"):
            with self.assertRaises(ValueError):
                datasheet.filled(f"<!-- {wrong} -->\n<!-- end -->")

    def test_every_module_is_listed(self):
        """The README has a table for each core."""
        text = datasheet.README.read_text()
        for core in cores.names():
            self.assertIn(f"<!-- modules {core} -->", text)


if __name__ == "__main__":
    unittest.main()
