"""mypy checks the annotations of the package, in the package itself and in programs that use it."""

import pathlib
import re
import shutil
import tempfile
import unittest

import mypy.api
import raygate

ROOT = pathlib.Path(__file__).parents[3]
PACKAGE = pathlib.Path(raygate.__file__).parent
RIGHT = """
import pickle
import numpy as np
import raygate

made: raygate.Scene = pickle.loads(pickle.dumps(raygate.Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], smooth=30)))
total: float = made.trace(np.zeros((2, 3), np.float32), [0, 0, 1], 5, hits="any", columns="hit")["hit"].sum()
names: list[str] = made.materials + made.warnings
count: int = made.rounding[0] + int(made.inside([[0, 0, 1]]).sum())
png: bytes = made.render(8, 8, eye=[0, 0, 5], spp=2).png(exposure=1)
"""
WRONG = {  # mypy's code for a line that it refuses
    'raygate.Scene("a.obj").trace([0, 0, 0], [[0, 0, 1]], hits="some")': "arg-type",
    'raygate.Scene("a.obj", smoth=3.0)': "call-overload",
    'raygate.Scene("a.obj").objects + 1': "operator",
    'raygate.Scene("a.obj").render(ssp=4)': "call-arg",
    'raygate.Scene("a.obj").render(filter="gauss")': "arg-type",
    'raygate.Scene("a.obj").volume': "attr-defined",
    'raygate.float.fp_add(1, 2, rounding="upward")': "arg-type",
}


class Types(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        # mypy does not check packages where they are installed.
        shutil.copytree(PACKAGE, cls.folder / "raygate", ignore=shutil.ignore_patterns("*.so"), ignore_dangling_symlinks=True)

    def mypy(self, text):
        """Returns mypy's lines on a program, and on the package that it imports."""
        (self.folder / "program.py").write_text(text)
        # The generated _raygate.pyi has arrays of any type.
        lines, errors, _ = mypy.api.run(["--strict", "--allow-any-generics", "--no-error-summary",
                                         f"--cache-dir={self.folder}/cache", str(self.folder / "program.py"),
                                         str(self.folder / "raygate")])
        self.assertEqual(errors, "")
        return lines.splitlines()

    def test_examples_are_typed(self):
        blocks = re.findall(r"```python\n(.*?)```", (ROOT / "host/docs/python.md").read_text(), re.DOTALL)
        self.assertGreater(len(blocks), 2)
        self.assertEqual(self.mypy("\n".join(blocks) + RIGHT), [])

    def test_mistakes_are_found(self):
        lines = self.mypy("import raygate\n" + "\n".join(WRONG))
        found = {(int(line.split(":")[1]), line.rsplit("[", 1)[1].rstrip("]")) for line in lines if ": error:" in line}
        self.assertEqual(found, set(enumerate(WRONG.values(), 2)), lines)


if __name__ == "__main__":
    unittest.main()
