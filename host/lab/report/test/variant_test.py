"""Tests the card of one variant: the command line's words, and the card's figures."""

import pathlib
import tempfile
import unittest

import numpy

from host.lab.report import plots
from host.lab.targets import variant


class Words(unittest.TestCase):
    def test_make_the_lines_of_the_table(self) -> None:
        self.assertEqual(variant.table([]), [{"variant": "binary32"}, {"variant": "e8p24"}])
        self.assertEqual(variant.table(["FRAC_WIDTH=15", "ADDER=prefix"]),
                         [{"variant": "binary32"}, {"variant": "e8p16-prefix", "digits": 16, "adder": "prefix"}])
        self.assertEqual(variant.table(["QUOTIENT_BITS=12", "ROUNDING=toward_zero", "EXP_WIDTH=6"]), [
            {"variant": "binary32"}, {"variant": "serial", "unit": "serial"},
            {"variant": "serial-e6p24-q12-toward-zero", "unit": "serial", "quotient_digits": 12, "rounding": "toward-zero",
             "exponent_bits": 6}])

    def test_a_file_takes_a_modules_place(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "mine.sv"
            file.write_text("module mine; endmodule\n")
            line = variant.table([f"MULTIPLIER={file}", "FRAC_WIDTH=15"])[-1]
            self.assertEqual((line["variant"], line["digits"], "adder" in line), ("e8p16-mine", 16, False))
            other = variant.table([f"ADDER={file}"])[-1]
            self.assertEqual((other["variant"], other["adder"]), ("e8p24-mine", "prefix"))
            self.assertNotEqual(line["brought"], other["brought"])
        with self.assertRaisesRegex(ValueError, "mine.sv: No such file"):
            variant.table([f"ADDER={file}"])
        with self.assertRaisesRegex(ValueError, "^MULTIPLIER=wallace: expected .*a file"):
            variant.table(["MULTIPLIER=wallace"])

    def test_doubts_are_ignored_where_no_bound_is_proven(self) -> None:
        for words in (["ROUNDING=down"], ["FRAC_WIDTH=9"]):
            self.assertIs(variant.table(words)[-1]["doubts"], False)
        self.assertNotIn("doubts", variant.table(["FRAC_WIDTH=10"])[-1])

    def test_what_cannot_be(self) -> None:
        for word, said in {"FRAC_WIDTH=99": "expected 2 to 23", "FRAC_WIDTH=x": "expected 2 to 23", "WIDTH=3": "expected one of",
                           "ROUNDING=odd": "expected nearest-even", "ADDER=fast": "expected graded, ripple", "UNIT=my.sv": "expected pipeline", "UNIT=": "pipeline"}.items():
            with self.assertRaisesRegex(ValueError, f"^{word}: .*{said}"):
                variant.table([word])
        for words in (["EXP_WIDTH=3"], ["FRAC_WIDTH=9", "QUOTIENT_BITS=12"]):
            with self.assertRaisesRegex(ValueError, "expected at most"):
                variant.table(words)
        with self.assertRaisesRegex(ValueError, "expected UNIT=serial"):
            variant.table(["UNIT=pipeline", "QUOTIENT_BITS=12"])


class Card(unittest.TestCase):
    def test_is_made_of_rows(self) -> None:
        format_of = {"unit": "pipeline", "exponent_bits": 8, "doubts": True, "flush": False, "fused": False, "rounding": "nearest-even",
                     "quotient_digits": 0}
        decisions = {"tests": 1000, "wrong_hits": 1, "wrong_misses": 2, "doubts": 4, "point_ulp": {"p99": 2.5}}
        exact = decisions | {"wrong_hits": 0, "wrong_misses": 0}
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            plots.save_pixels(numpy.zeros((2, 3, 3)), folder / "seen.png")
            rows = [{"table": "machine"}]
            for line, digits in (("binary32", 24), ("e8p16", 16)):
                frame = {"table": "pictures", "variant": line, "scene": "scenes/cornell.obj", "unit_tests": 50, "clocks": 60}
                rows += [{"table": "variants", "variant": line, "digits": digits, **format_of}, {**frame, "engine": "unit"},
                         {**frame, "engine": "model", "decisions": exact if digits == 24 else decisions, "flip": 0.5, "picture": str(folder / "seen"),
                          "map": str(folder / "seen.png")}]
            values = variant.values(rows, folder)
            self.assertTrue(values["pictures"].with_suffix(".png").exists())
            self.assertEqual((values["mine"]["variant"], values["mine"]["wrong"], values["mine"]["clocks"]), ("e8p16", 3000.0, 60.0))
            self.assertEqual([tuple(line.values()) for line in values["figures"]], [
                ("clocks a frame", 1.0, "60", "60"), ("wrong tests a million", None, "0.0", "3000.0"), ("doubts a million", 1.0, "4000.0", "4000.0"),
                ("P, ulp: 99 %", 1.0, "2.5", "2.5"), ("FLIP", 1.0, "0.50000", "0.50000")])
