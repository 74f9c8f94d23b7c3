"""Tests the commands that `pip install .` installs beside the module: raygate-render and the others."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

import raygate

SCENES = pathlib.Path(__file__).parents[3] / "scenes"


class Commands(unittest.TestCase):
    def run_command(self, name, *words, **options):
        return subprocess.run([pathlib.Path(sys.executable).with_name(f"raygate-{name}"), *words], check=True, capture_output=True, **options).stdout

    def test_trace_prints_what_the_module_returns(self):
        hits = self.run_command("trace", SCENES / "teapot.obj", "-", "--columns", "triangle,t", input=b"0,1,5,0,0,-1\n", cwd="/")
        triangle, t = hits.split()[1].decode().split(",")
        hit = raygate.Scene(SCENES / "teapot.obj").trace([0, 1, 5], [[0.0, 0.0, -1.0]])
        self.assertEqual((int(triangle), float(t)), (hit["triangle"][0], hit["t"][0]))

    def test_render_and_merge(self):
        with tempfile.TemporaryDirectory() as folder:
            for part in ("0:1", "1:2"):
                self.run_command("render", SCENES / "cornell.json", "--quiet", "--size", "16x12", "--spp", "2", "--samples", part,
                                 "-o", f"part-{part[0]}.exr", cwd=folder)
            self.run_command("merge", "part-0.exr", "part-1.exr", "-o", "merged", cwd=folder)
            self.run_command("render", SCENES / "cornell.json", "--quiet", "--size", "16x12", "--spp", "2", "-o", "whole", cwd=folder)
            self.assertEqual(*((pathlib.Path(folder) / name).read_bytes() for name in ("merged.exr", "whole.exr")))


if __name__ == "__main__":
    unittest.main()
