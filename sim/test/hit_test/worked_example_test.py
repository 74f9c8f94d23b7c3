"""Checks the output of `make lecture EXAMPLE=1`: the worked example's words, and a waveform with the signals of GTKWave's save file.

usage: worked_example_test.py WORKED_EXAMPLE SAVE_FILE
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SAVE_FILE = sys.argv[1:]


def lines(*options):
    """Returns the program's output."""
    return subprocess.run([PROGRAM, *options], check=True, capture_output=True,
                          text=True).stdout.splitlines()


def last_line(*options):
    """Returns the last line of the output."""
    return lines(*options)[-1]


class WorkedExample(unittest.TestCase):
    """Runs the program with and without the paper's divider."""

    def test_words(self):
        """With the paper's divider, P has the paper's words. With the exact divider, P is correctly rounded."""
        self.assertRegex(last_line(), "^P = 3DC873FD 3E31C2A2 3DB0D093 .* 10 clocks ")
        self.assertRegex(last_line("--paper-divider"), "^P = 3DC873F8 3E31C2A0 3DB0D090 .* 10 clocks ")

    def test_inputs_in_decimal(self):
        """The inputs are the paper's numbers."""
        self.assertEqual(lines()[0], "I = (3.3125, 5.875, 2.921875), N = (15.1875, 0.46875, 2.109375), "
                         "d = 1.75: the words 1 to 7")

    def test_noise_of_the_bus_is_not_shown(self):
        """Between tests the bus carries noise, which goes through N into I-3, I-2 and I-1."""
        rows = [line.split() for line in lines()[2:-1]]
        self.assertEqual(rows[0], "1 Ix - - - 40540000 - - -".split())
        self.assertEqual(rows[6][2:], "40540000 40BC0000 403B0000 40070000 3FE00000 426CE740 426CE740".split())
        self.assertEqual(rows[7][1:5], "40BC0000 403B0000 40070000 -".split())
        self.assertEqual(rows[9][1:5], "40070000 - - -".split())

    def test_waveform(self):
        """Every signal of the save file is in the waveform, with its width."""
        with tempfile.TemporaryDirectory() as folder:
            trace = pathlib.Path(folder) / "trace.vcd"
            last_line("--trace", trace)
            text = trace.read_text()
        scopes, there = [], set()
        for word, rest in re.findall(r"\$(scope|upscope|var) (.*?) ?\$end", text):
            if word == "scope":
                scopes.append(rest.split()[1])
            elif word == "upscope":
                scopes.pop()
            else:
                there.add(".".join([*scopes, "".join(rest.split()[3:])]))
        shown = re.findall(r"^\+\{[^}]+\} (\S+)$", pathlib.Path(SAVE_FILE).read_text(), re.M)
        self.assertGreater(len(shown), 20)
        self.assertEqual(sorted(set(shown) - there), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
