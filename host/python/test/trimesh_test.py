"""raygate.trimesh, and with RAYGATE_TRIMESH=1 (`make test LONG=trimesh`) trimesh's own tests of rays with our intersector.

trimesh's tests are from its source distribution on PyPI, without their helpers and models. A few lines and meshes made here replace
these. Left out: test_rays (needs models that the distribution lacks) and test_contains_cavity (needs manifold3d).
"""

import importlib
import itertools
import os
import pathlib
import subprocess
import sys
import tarfile
import tempfile
import time
import types
import unittest

import numpy as np

from raygate.trimesh import RayMeshIntersector

VERSION = "5.2.0"
CUBE = types.SimpleNamespace(
    vertices=np.array(list(itertools.product((-1.0, 1.0), repeat=3))),
    faces=np.array([[0, 1, 3], [0, 3, 2], [4, 7, 5], [4, 6, 7], [0, 5, 1], [0, 4, 5], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 7, 3], [1, 5, 7]]))


class Intersector(unittest.TestCase):
    def test_edges_and_vertices_are_hit_once(self):
        rays = RayMeshIntersector(CUBE)
        origins, directions = np.zeros((8, 3)), CUBE.vertices
        points, numbers, triangles = rays.intersects_location(origins, directions)
        self.assertEqual(numbers.tolist(), list(range(8)))
        np.testing.assert_allclose(points, CUBE.vertices)
        np.testing.assert_array_equal(rays.intersects_first(origins, directions), triangles)
        self.assertTrue(rays.intersects_any(origins, directions).all())

    def test_all_hits_in_order(self):
        rays = RayMeshIntersector(CUBE)
        origins, directions = [[-5, 0.2, 0.1], [-5, 9, 0], [0, 0.1, 0.2]], [[2, 0, 0]] * 3
        triangles, numbers, points = rays.intersects_id(origins, directions, return_locations=True)
        self.assertEqual(numbers.tolist(), [0, 0, 2])
        np.testing.assert_allclose(points, [[-1, 0.2, 0.1], [1, 0.2, 0.1], [1, 0.1, 0.2]])
        self.assertEqual(rays.intersects_first(origins, directions).tolist(), [triangles[0], -1, triangles[2]])
        self.assertEqual(rays.intersects_any(origins, directions).tolist(), [True, False, True])
        self.assertEqual([len(part) for part in rays.intersects_id(origins, directions, max_hits=1)], [2, 2])
        self.assertEqual([len(part) for part in rays.intersects_id(origins, directions, multiple_hits=False)], [2, 2])
        self.assertEqual([part.shape for part in rays.intersects_location([[9, 9, 9]], [[1, 0, 0]])], [(0, 3), (0,), (0,)])

    def test_cavities_faces_turned_over_and_directions_of_zero(self):
        faces = np.concatenate([CUBE.faces, CUBE.faces + 8])
        faces[3] = faces[3][::-1]
        rays = RayMeshIntersector(types.SimpleNamespace(vertices=np.concatenate([CUBE.vertices, CUBE.vertices / 2]), faces=faces))
        points = np.random.default_rng(1).uniform(-1.5, 1.5, (2000, 3))
        size = np.abs(points).max(axis=1)
        np.testing.assert_array_equal(rays.contains_points(points), (size < 1) & (size > 0.5))
        self.assertEqual(rays.intersects_any([[0, 0, 5]] * 2, [[0, 0, 0], [0, 0, -1]]).tolist(), [False, True])
        with self.assertRaisesRegex(ValueError, "^geometry: found a value of type str, expected a mesh$"):
            RayMeshIntersector("x").intersects_any([[0, 0, 5]], [[0, 0, 1]])

    def test_follows_changes_of_the_mesh(self):
        mesh = types.SimpleNamespace(vertices=CUBE.vertices.copy(), faces=CUBE.faces)
        rays = RayMeshIntersector(mesh)
        self.assertEqual(rays.contains_points([[0, 0, 0], [1.5, 0, 0]]).tolist(), [True, False])
        mesh.vertices += 1
        self.assertEqual(rays.contains_points([[0.1, 0.1, 0.1], [1.5, 0.2, 0.3], [-0.5, 0, 0]]).tolist(), [True, True, False])


@unittest.skipUnless(os.environ.get("RAYGATE_TRIMESH"), "RAYGATE_TRIMESH=1 installs trimesh")
class TheirTests(unittest.TestCase):
    def test_with_our_intersector(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--target", folder / "site", f"trimesh=={VERSION}", "scipy", "networkx"], check=True)
            subprocess.run([sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--no-binary", ":all:", "-d", folder, f"trimesh=={VERSION}"], check=True)
            with tarfile.open(folder / f"trimesh-{VERSION}.tar.gz") as archive:
                archive.extractall(folder, filter="data")
            sys.path[:0] = [str(folder / "site"), str(folder / f"trimesh-{VERSION}" / "tests")]
            import trimesh
            from trimesh import creation, ray
            from trimesh.ray import ray_triangle

            meshes = {"unit_sphere.STL": creation.icosphere, "unit_cube.STL": creation.box, "7_8ths_cube.stl": lambda: creation.box(extents=[20, 20, 20]),
                      "teapot.stl": lambda: trimesh.load(pathlib.Path(__file__).parents[3] / "scenes" / "teapot.obj", force="mesh")}
            ray_triangle.RayMeshIntersector = RayMeshIntersector
            ray.has_embree = False
            helpers = types.ModuleType("generic")
            helpers.__dict__.update(np=np, trimesh=trimesh, time=time, log=trimesh.util.log, random=np.random.default_rng(1).random,
                                    get_mesh=lambda name, **_: meshes[name]())
            sys.modules["generic"] = helpers
            tests = importlib.import_module("test_ray")
            ran = 0
            for name in (name for name in dir(tests) if name.startswith("test_") and name not in ("test_rays", "test_contains_cavity")):
                with self.subTest(name):
                    getattr(tests, name)()
                    ran += 1
            self.assertIsInstance(creation.box().ray, RayMeshIntersector)
            self.assertGreaterEqual(ran, 9)


if __name__ == "__main__":
    unittest.main()
