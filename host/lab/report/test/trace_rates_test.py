"""The rays that ./trace is timed with."""

import pathlib
import tempfile
import unittest

import numpy

from host.lab.targets import speed


class TraceRates(unittest.TestCase):
    def test_rays_come_from_outside_and_pass_the_box(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "s.obj"
            scene.write_text("v 1 2 3\nv 2 4 6\n# v 9 9 9\nvn 0 0 1\nf 1 2 1\n")
            rays = speed.rays_around(scene, 500)
        self.assertEqual(rays.shape, (500, 6))
        self.assertEqual(rays.dtype, numpy.float32)
        origins, targets = rays[:, :3], rays[:, :3] + rays[:, 3:]
        self.assertTrue(((targets > [0.99, 1.99, 2.99]) & (targets < [2.01, 4.01, 6.01])).all())
        self.assertTrue(((origins < [1, 2, 3]) | (origins > [2, 4, 6])).any(axis=1).all())


if __name__ == "__main__":
    unittest.main()
