"""The table of evidence names every module of hw/, and proofs that are there."""

import csv
import re
import unittest

from synth import cores, prove

EVIDENCE = prove.PROOFS / "evidence.csv"


class Evidence(unittest.TestCase):
    """synth/proofs/evidence.csv."""

    def setUp(self):
        self.rows = list(csv.DictReader(EVIDENCE.read_text().splitlines()))

    def test_every_module_has_a_row(self):
        modules = {file.stem for name in cores.names() for file in cores.files(name)}
        self.assertNotEqual(modules, set())
        self.assertEqual({row["module"] for row in self.rows} ^ modules, set())
        for row in self.rows:
            self.assertRegex(row["evidence"], r"^(as|exhaustive|proof|random)\b")

    def test_every_proof_it_names_is_there(self):
        named = re.findall(r"\b((?:adder|booth|float|unit)\.[\w.]+)", " ".join(row["by"] for row in self.rows))
        proofs = [proof.name for proof in prove.all_proofs()]
        self.assertNotEqual(named, [])
        for name in named:
            self.assertTrue(any(proof.startswith(name) for proof in proofs), name)


if __name__ == "__main__":
    unittest.main()
