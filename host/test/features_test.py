"""host/features.csv, EMBEDDING.md and hw/ray_core/README.md against the code: every test that they name exists, and every
option of the programs has a row."""

import csv
import pathlib
import re
import unittest

HOST = pathlib.Path(__file__).resolve().parents[1]
TESTS = re.compile(r"^\s*TEST(?:_F|_P)?\((\w+),\s*(\w+)|^\s+def (test_\w+)", re.MULTILINE)
OPTION = re.compile(r'(?<=[" ,])--[a-z][a-z-]+(?=[",])')


def sources(pattern: str) -> str:
    return "\n".join(path.read_text() for path in sorted(HOST.glob(pattern)))


class Features(unittest.TestCase):
    def setUp(self) -> None:
        with (HOST / "features.csv").open(newline="") as file:
            self.rows = list(csv.DictReader(file))
        self.assertGreater(len(self.rows), 30)
        text = (HOST / "EMBEDDING.md").read_text()
        rows = [line.strip("|").split("|") for line in text.splitlines() if line.startswith("| ")]
        self.promises = [(promise, re.findall(r"`([\w.]+)`", tests)) for _, promise, tests in rows if promise.strip() != "Promise"]
        self.assertGreater(len(self.promises), 10)

    def test_every_test_exists(self) -> None:
        found = TESTS.findall(sources("**/test/*.cpp") + sources("**/test/*.py"))
        names = {f"{suite}.{name}" if suite else function for suite, name, function in found}
        for feature, named in [(row["feature"], row["tests"].split()) for row in self.rows] + self.promises:
            self.assertTrue(named, feature)
            for name in named:
                self.assertTrue(name in names, f"{feature.strip()}: no test {name}")

    def test_every_test_of_the_ray_core_exists(self) -> None:
        root = HOST.parent
        text = (root / "hw/ray_core/README.md").read_text().partition("## What holds it")[2]
        named = re.findall(r"`([\w.]+\.[\w.]+)`", text.partition("|---")[2])
        self.assertGreater(len(named), 20)
        tests = [file for room in ("sim", "host/intersect/core") for file in (root / room).glob("**/test/**/*")
                 if file.suffix in (".cpp", ".txt")]
        found = re.findall(r"TEST(?:_[FP])?\((\w+), (\w+)\)|add_test\(NAME ([\w.]*\w)", "\n".join(file.read_text() for file in tests))
        names = {f"{suite}.{name}" if suite else other for suite, name, other in found}
        proofs = (root / "synth/unit_proofs.py").read_text() + (root / "synth/proofs/proofs.csv").read_text()
        names |= set(re.findall(r"\bunit\.\w+", proofs))
        self.assertEqual(set(named) - names, set())

    def test_every_option_has_a_row(self) -> None:
        listed = set(re.findall(r"--[a-z-]+", " ".join(row["asked for by"] for row in self.rows)))
        real = set(OPTION.findall(sources("cli/*.cpp") + sources("options/*.cpp")))
        self.assertTrue(real)
        self.assertEqual(real - listed, set(), "options without a row")
        self.assertEqual(listed - real, set(), "rows of options that no program has")


if __name__ == "__main__":
    unittest.main()
