"""The page of proofs names every module of hw/, each with its evidence."""

import pathlib
import re
import unittest

from synth import cores, prove

PAGE = pathlib.Path(prove.__file__).parent / "proofs" / "README.md"


class ProofsPage(unittest.TestCase):
    """synth/proofs/README.md."""

    def test_every_module_has_a_row(self):
        rows = re.findall(r"^\| `(\w+)` \| (as|exhaustive|proof|random)\b", PAGE.read_text(), re.M)
        modules = {file.stem for name in cores.names() for file in cores.files(name)}
        self.assertNotEqual(modules, set())
        self.assertEqual({name for name, _ in rows} ^ modules, set())

    def test_every_proof_it_names_is_there(self):
        evidence = PAGE.read_text().split("## Every module")[1]
        named = re.findall(r"`((?:adder|booth|float|unit)\.[\w.]+)", evidence)
        proofs = [proof.name for proof in prove.all_proofs()]
        self.assertNotEqual(named, [])
        for name in named:
            self.assertTrue(any(proof.startswith(name) for proof in proofs), name)


if __name__ == "__main__":
    unittest.main()
