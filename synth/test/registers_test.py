"""The registers' page and what is made of it."""

import unittest

from synth import cores, registers


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


if __name__ == "__main__":
    unittest.main()
