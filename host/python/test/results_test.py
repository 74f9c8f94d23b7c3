"""raygate.results: what is read of the lab's rows, of synthesis, and of pages."""

import pathlib
import tempfile
import unittest

import raygate

ROOT = pathlib.Path(__file__).parents[3]


class Frames(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "file"

    def refusal(self, function, text):
        self.file.write_text(text)
        with self.assertRaises(ValueError) as caught:
            function(self.file)
        return str(caught.exception).removeprefix(str(self.file))

    def test_bench(self):
        self.file.write_text('{"table": "a", "x": 1, "y": {"z": 2}}\n{"table": "b"}\n'
                             '{"table": "a", "x": 3}\n')
        frames = raygate.results.bench(self.file)
        self.assertEqual(list(frames), ["a", "b"])
        self.assertEqual(frames["a"]["x"].tolist(), [1, 3])
        self.assertEqual(frames["a"]["y.z"][0], 2)
        self.assertEqual(self.refusal(raygate.results.bench, '{"table": "a"}\n[1]\n'),
                         ":2: found '[1]', expected a JSON object with a \"table\"")

    def test_synth(self):
        self.file.write_text('{"tools": "", "results": [{"design": "adder", "area": 7.0, '
                             '"path": [{"pin": "a"}]}]}')
        frame = raygate.results.synth(self.file)
        self.assertEqual((frame["design"][0], frame["area"][0]), ("adder", 7.0))
        for text in ("", "[]", "{}", '{"results": 1}'):
            self.assertIn("expected what make synth writes",
                          self.refusal(raygate.results.synth, text))
        with self.assertRaisesRegex(ValueError, "No such file or directory; `make synth` writes it"):
            raygate.results.synth("none.json")

    def test_pages(self):
        adders = raygate.results.published(ROOT / "synth/results/README.md")["The 48-bit adders"]
        self.assertEqual(adders["adder"][0], "ripple")
        self.assertRegex(adders["fast"][0], r"^\d+ / \d+\.\d+$")
        self.file.write_text("# A\n\n| x | | |\n|---|---|---|\n| 1,024 | a | b |\n| 2 | c | d |\n")
        frame = raygate.results.published(self.file)["A"]
        self.assertEqual(frame["x"].tolist(), [1024, 2])
        self.assertEqual(frame.shape, (2, 3))


if __name__ == "__main__":
    unittest.main()
