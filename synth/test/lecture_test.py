"""Tests values of netlists against Python's arithmetic, and the page that shows these values."""

import argparse
import contextlib
import html.parser
import io
import pathlib
import random
import re
import struct
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

from synth import catalogue, lecture, store, structure, tools


def given(**changed: object) -> argparse.Namespace:
    """Returns the options of a page of eight bits."""
    return argparse.Namespace(**{"width": 8, "groups": None, "a": 181, "b": 90, "carry": 1, "x": 1.5, "y": -0.3} | changed)


class Values(unittest.TestCase):
    def test_adders_add(self) -> None:
        """Each kind adds, with and without constants. Removing constants saves gates only in kinds that have constants."""
        numbers = random.Random(1)
        for kind, look_ahead in (("ripple", None), ("uniform", False), ("graded", True), ("graded", False), ("prefix", None)):
            whole = structure.netlist(catalogue.design("adder", adder=kind, look_ahead=look_ahead, Width=9))
            fewer = structure.without_constants(whole)
            self.assertEqual(len(fewer["cells"]) < len(whole["cells"]), kind == "prefix" or look_ahead is True)
            for _ in range(100):
                a, b, carry = numbers.getrandbits(9), numbers.getrandbits(9), numbers.getrandbits(1)
                for module in (whole, fewer):
                    values = structure.evaluate(module, {"a_i": a, "b_i": b, "carry_i": carry})
                    bits = module["ports"]["sum_o"]["bits"] + module["ports"]["carry_o"]["bits"]
                    self.assertEqual(structure.word(bits, values), a + b + carry)

    def test_a_float_adder_adds(self) -> None:
        module = structure.netlist(catalogue.design("fp_adder", ExpWidth=5, FracWidth=10))
        numbers = random.Random(2)
        for _ in range(100):
            a, b = (numbers.getrandbits(16) & 0xbfff for _ in range(2))  # finite, and so is their sum
            values = structure.evaluate(module, {"a_i": a, "b_i": b, "subtract_i": 0, "rounding_mode_i": 0, "tininess_after_i": 0})
            x, y = struct.unpack("<ee", struct.pack("<HH", a, b))
            result = structure.word(module["ports"]["result_o"]["bits"], values)
            self.assertEqual(result, struct.unpack("<H", struct.pack("<e", x + y))[0])


class Page(unittest.TestCase):
    def test_has_each_cell_and_the_results(self) -> None:
        page = lecture.page(given())
        self.assertEqual(page.count("181 + 90 + 1 = <b>272</b>"), len(lecture.KINDS))
        self.assertIn("181 x 90 = <b>16290</b>", page)
        self.assertIn("1.5 + -0.300048828125 = <b>1.2001953125</b>", page)
        ripple = page[page.index("Ripple carry"):page.index("groups of one width")]
        self.assertEqual(ripple.count(">FA<"), 8)
        self.assertEqual(ripple.count("cell slow"), 8)
        self.assertIn("8 full-adder delays", ripple)
        self.assertEqual(re.findall(r"Group widths, lowest first: ([\d, ]*)\. Slowest", lecture.page(given(groups=[1, 2, 1, 4]))), ["4, 4", "1, 2, 1, 4"])

    def test_default_operands_fit(self) -> None:
        with (tempfile.TemporaryDirectory() as folder, mock.patch.object(store, "OUT", pathlib.Path(folder)),
              mock.patch.object(sys, "argv", ["lecture", "--width", "8", "--b", "7"]), contextlib.redirect_stdout(io.StringIO())):
            self.assertEqual(lecture.main(), 0)
            self.assertIn("85 + 7 + 0 = <b>92</b>", (store.OUT / "lecture.html").read_text())

    def test_has_a_name_for_every_word_of_the_near_path(self) -> None:
        self.assertIn("near_difference", lecture.page(given(x=1.0, y=-0.99)))

    def test_booth_rows_add_up(self) -> None:
        """Checks the displayed rows, and the two rows that the last adder takes."""
        numbers = random.Random(3)
        for a, b in [(181, 90), (0, 7), *((numbers.getrandbits(8), numbers.getrandbits(8)) for _ in range(5))]:
            page = re.sub(r"</?(?:b|code)>|\u2009", "", lecture.booth_section(given(a=a, b=b)))
            rows = re.findall(r"<tr><td>(row \d|sum)</td><td>([01]{16})</td><td>(\d+)", page)
            self.assertEqual([name for name, _, _ in rows], [*(f"row {k}" for k in range(5)), "sum"])
            self.assertTrue(all(int(bits, 2) == int(number) for _, bits, number in rows))
            *parts, total = (int(number) for _, _, number in rows)
            self.assertEqual((sum(parts) % 2**16, total), (a * b, a * b))
            last = re.search(r"<td>last</td><td>sum \d</td><td>\d+</td><td>(\d+)</td></tr><tr><td></td><td>carry \d</td><td>\d+</td>"
                             r"<td>(\d+)</td></tr><tr><td></td><td>product</td><td>\d+</td><td>(\d+)</td>", page)
            self.assertEqual((sum(map(int, last.groups()[:2])) % 2**16, int(last[3])), (a * b, a * b))

    def test_float_words_end_with_the_result(self) -> None:
        for y, said, bits in ((-0.3, "one integer bit, ten fraction bits, two guard bits", "0 01111 0011001101"),
                              (0.7, "two integer bits, ten fraction bits, one guard bit", "0 10000 0001100110")):
            page = lecture.float_section(given(y=y))
            self.assertIn(said, page)
            self.assertIn(f"<code>result_o</code></td><td><code>{bits.replace(' ', chr(0x2009))}</code>", page)

    def test_opens_and_closes_each_element(self) -> None:
        opened: list[str] = []

        class Reader(html.parser.HTMLParser):
            def handle_starttag(self, tag: str, attrs: object) -> None:
                if tag != "meta":
                    opened.append(tag)

            def handle_endtag(self, tag: str) -> None:
                assert opened.pop() == tag

        Reader().feed(lecture.page(given(groups=[3, 5])))
        self.assertEqual(opened, [])

    def test_lines_of_readme_and_tutorial_draw(self) -> None:
        lines = [line for page in ("README.md", "host/docs/hardware.md") for line in
                 re.findall(r"make lecture( A=[^#`\n]*)", (tools.ROOT / page).read_text())]
        self.assertGreaterEqual(len(lines), 2)
        for line in lines:
            words = dict(word.split("=") for word in line.split())
            options = {"width": 16, "carry": 0, "x": 1.5, "y": -0.3} | {name.lower(): float(value) if name in "XY" else int(value)
                                                                         for name, value in words.items()}
            page = lecture.page(given(**options))
            self.assertEqual(page.count(f"{options['a']:,} + {options['b']:,}".replace(",", "")), len(lecture.KINDS))

    def test_says_what_it_cannot_draw(self) -> None:
        for options, words in ((["--width", "12", "--a", "5000"], "expected numbers of 12 bits"), (["--groups", "3,4"], "expected 16 bits together"),
                               (["--x", "1e9"], "expected a number from -65504"), (["--y", "two"], "got 'two'"), (["--width", "17"], "from 2 to 16")):
            run = subprocess.run([sys.executable, "-m", "synth.lecture", *options], cwd=tools.ROOT, capture_output=True, text=True, check=False)
            self.assertEqual(run.returncode, 2, options)
            self.assertIn(words, run.stderr)
