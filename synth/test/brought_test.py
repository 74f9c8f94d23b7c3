"""Tests user-supplied modules: malformed modules are refused with a line number, wrong modules are refuted in words."""

import contextlib
import io
import pathlib
import re
import sys
import tempfile
import unittest
import unittest.mock

from synth import __main__ as program, brought, catalogue, measure, store

EXERCISES = catalogue.HW.parent / "host" / "lab" / "exercises"
PORTS = """(
  input logic [Width-1:0] a_i, b_i,
  input logic carry_i,
  output logic [Width-1:0] sum_o,
  output logic carry_o);
"""
HEAD = f"module mine #(parameter int unsigned Width = 48) {PORTS}"
ADDS = "  assign {carry_o, sum_o} = a_i + b_i + (Width + 1)'(carry_i);\nendmodule\n"
# An adder without the carry into bit 3 of the sum.
FORGETS = """
  logic [Width-1:0] right;
  assign {carry_o, right} = (Width + 1)'(a_i) + (Width + 1)'(b_i) + (Width + 1)'(carry_i);
  assign sum_o = {right[Width-1:4], a_i[3] ^ b_i[3], right[2:0]};
endmodule
"""


class Brought(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        patch = unittest.mock.patch.object(store, "OUT", self.folder / "synth")
        patch.start()
        self.addCleanup(patch.stop)

    def file(self, text: str | bytes, name: str = "mine.sv") -> str:
        file = self.folder / name
        file.parent.mkdir(exist_ok=True)
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
        return str(file)

    def judged(self, **files: str) -> list[dict]:
        brought.bring(files)
        return brought.judge(files, catalogue.design("hit_test_pipeline", Arith=4))

    def test_what_is_no_such_module(self) -> None:
        for text, said in {
                "": ":1: found no module",
                f"{HEAD}  assign sum_o = a_i\nendmodule\n": ":6:21: expected ';'",
                f"{HEAD}  other u_other();\nendmodule\n": ":6:3: unknown module 'other'",
                f"{HEAD}  prefix_adder u_a (.*);\nendmodule\n": ":1: module mine: uses prefix_adder, whose place it takes",
                f"module mine {PORTS.replace('Width', '48')}{ADDS.replace('Width', '48')}": ":1: module mine: has no parameter Width, expected as in",
                f"// mine\n{HEAD.replace('carry_i', 'cin')}{ADDS.replace('carry_i', 'cin')}":
                    ":2: module mine: carry_i: found no such port, expected as in hw/arith/prefix_adder.sv: input of 1 bits",
                f"{HEAD.replace('output logic [Width-1:0]', 'output logic [47:0]')}{ADDS}":
                    r"sum_o: found output of 48 bits, expected as in .*: output of 13 bits \(Width = 13\)"}.items():
            with self.subTest(said), self.assertRaisesRegex(ValueError, f"^{self.folder}/mine.sv.*{said}"):
                brought.bring({"ADDER": self.file(text)})
        with self.assertRaisesRegex(ValueError, "nowhere.sv: No such file"):
            brought.bring({"ADDER": "nowhere.sv"})

    def test_files_alone(self) -> None:
        bad = self.file(f"{HEAD}  assign sum_o = a_i\nendmodule\n")
        for words, status, said in (([f"ADDER={bad}"], 2, rf"error: {bad}:6:21: expected ';'\n"),
                                    ([f"UNIT={bad}"], 2, r"error: UNIT=.*: found a file, expected one of ADDER, MULTIPLIER, .*\n"),
                                    ([f"ADDER={EXERCISES}/kogge_stone_adder.sv"], 0, "")):
            told = io.StringIO()
            with contextlib.redirect_stderr(told), unittest.mock.patch.object(sys, "argv", ["brought", *words]):
                self.assertEqual(brought.main(), status, words)
            self.assertRegex(told.getvalue(), f"^{said}$")

    def test_files_as_other_tools_write_them(self) -> None:
        """Accepts all byte order marks, encodings, line ends, time scales, default net types and names. Proves the last of these files."""
        module = f"`timescale 1ns / 1ps\n`default_nettype none\n{HEAD.replace('logic', 'wire')}{ADDS}"
        multiplier = ("// prefix_adder, booth_multiplier\r\n`timescale 1ps/1ps\r\nmodule half_adder(input a, b, output s); timeunit 1ns; assign s = a ^ b; "
                      "endmodule : half_adder\r\nmodule times #(parameter Width = 24) (input [Width-1:0] a_i, b_i, output [2*Width-1:0] "
                      "product_o);\r\n  half_adder u_half_adder (.a(a_i[0]), .b(b_i[0]), .s());\r\n  assign product_o = a_i * b_i;\r\n"
                      "endmodule\r\n")
        for adder, name in ((f"\ufeff{module}".encode(), "mark.sv"), (module.encode("utf-16"), "wide.sv"),
                            (module.replace("\n", "\r\n").encode(), "lines.sv"), (module.replace("\n", "\r").encode(), "returns.sv"),
                            (f"// Gr\u00f6\u00dfe\n{module}".encode("latin-1"), "my prefix_adder/prefix_adder \"100%\".sv")):
            with self.subTest(name):
                files = {"ADDER": self.file(adder, name), "MULTIPLIER": self.file(multiplier, "times.v")}
                brought.bring(files)
        rows = brought.judge(files, catalogue.design("hit_test_pipeline", Arith=4))
        self.assertEqual({(row["word"], row["holds"]) for row in rows}, {("ADDER", True), ("MULTIPLIER", True)})
        with self.assertRaisesRegex(ValueError, r'/my prefix_adder/a "b" 7%.sv:7:1: expected expression'):
            brought.bring({"ADDER": self.file(f"{HEAD}  assign sum_o = a_i - \nendmodule\n", 'my prefix_adder/a "b" 7%.sv')})

    def test_a_counterexample_in_words(self) -> None:
        row = self.judged(ADDER=self.file(HEAD + FORGETS))[-1]
        self.assertFalse(row["holds"])
        found = row["counterexample"]
        self.assertRegex(found, r"^carry, sum = a \+ b \+ carry at 7 bits: refuted by a = \d+ \(0x[0-9A-F]{2}\), b = \d+ \(0x[0-9A-F]{2}\), "
                         r"carry in = [01]: it says sum = \d+ \(0x[0-9A-F]{2}\), carry out = [01]; right is sum = \d+ \(0x[0-9A-F]{2}\), "
                         "carry out = [01]$")
        a, b, carry, says, _, right, _ = map(int, re.findall(r"= (\d+)", found))
        self.assertEqual((right, says), ((a + b + carry) % 128, right ^ 8))

    def test_a_refuted_adder_alone(self) -> None:
        """`make synth TOP=adder ADDER=FILE` ends with the counterexample, in the same words, and measures nothing."""
        told, words = io.StringIO(), ["synth", "--top", "adder", "--adder", self.file(HEAD + FORGETS), "--width", "7"]
        with (contextlib.redirect_stderr(told), unittest.mock.patch.object(sys, "argv", words),
              unittest.mock.patch.object(measure, "measure", side_effect=AssertionError("the run does not end"))):
            self.assertEqual(program.main(), 1)
        self.assertRegex(told.getvalue(), r"^synth: proof that it adds: refuted by a = \d+ .*: it says sum = \d+ .*; right is sum = \d+ .*\n$")

    def test_the_exercises(self) -> None:
        rows = self.judged(ADDER=str(EXERCISES / "kogge_stone_adder.sv"))
        self.assertGreater(len(rows), 5)
        self.assertEqual([row["claim"] for row in rows if not row["holds"]], [])
        (row,) = self.judged(MULTIPLIER=str(EXERCISES / "truncating_multiplier.sv"))
        self.assertRegex(row["counterexample"], r"^product = a \* b at 5 bits: refuted by a = \d+ .*it says product = 0 \(0x000\); right is")

    def test_names_of_hardware_are_free_to_use(self) -> None:
        """Proves an adder that has the name of the module that it replaces, and a multiplier that has another name."""
        rows = self.judged(ADDER=self.file((catalogue.HW / "arith/prefix_adder.sv").read_text()), MULTIPLIER=self.file(
            "module times #(parameter Width = 24) (input [Width-1:0] a_i, b_i, output [2*Width-1:0] product_o);\n"
            "  assign product_o = a_i * b_i;\nendmodule\n", "times.v"))
        self.assertEqual({(row["word"], row["holds"]) for row in rows}, {("ADDER", True), ("MULTIPLIER", True)})

    def test_rows_and_rounders(self) -> None:
        row = (catalogue.HW / "arith/srt_row.sv").read_text()
        self.assertTrue(all(each["holds"] for each in self.judged(DIVIDER_ROW=self.file(row))))
        broken = row.replace("y >= M0[", "y >= M2[")
        self.assertIn("refuted by", self.judged(DIVIDER_ROW=self.file(broken))[-1]["counterexample"])
        rounder = (catalogue.HW / "fp/fp_round.sv").read_text().replace("fp_pkg::RoundNearestEven", "fp_pkg::RoundNearestMaxMagnitude")
        self.assertIn("refuted by", self.judged(ROUNDER=self.file(rounder))[-1]["counterexample"])
