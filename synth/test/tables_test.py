"""What is written and compared: tables."""

import unittest

from synth import tables


class Tables(unittest.TestCase):
    """tables' two forms."""

    def test_markdown(self):
        """Columns line up, numbers to the right."""
        self.assertEqual(tables.markdown(["what", "ns"], [["a", "9.5"], ["b", "10.5"]]),
                         "| what |   ns |\n|------|-----:|\n| a    |  9.5 |\n| b    | 10.5 |\n")

    def test_comma_separated(self):
        """What a row has not is left empty; what is not asked for is left out."""
        self.assertEqual(tables.comma_separated([{"a": 1, "c": 2}], ["a", "b"]), "a,b\n1,\n")


if __name__ == "__main__":
    unittest.main()
