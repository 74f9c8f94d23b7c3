"""The Python module: built in build/host/python, or installed by `pip install .`."""

import concurrent.futures
import ctypes
import fractions
import os
import pathlib
import pickle
import platform
import random
import re
import resource
import signal
import tempfile
import threading
import time
import unittest
import warnings

import numpy as np

import raygate
import raygate.float

SCENES = pathlib.Path(__file__).parents[3] / "scenes"


class Trace(unittest.TestCase):
    def setUp(self):
        self.scene = raygate.Scene(SCENES / "teapot.obj")
        random = np.random.default_rng(1)
        self.origins = random.normal(size=(2000, 3)) * 3 + [0, 1, 0]
        self.directions = [0, 1, 0] - self.origins + random.normal(size=(2000, 3))

    def test_hits_lie_where_they_say(self):
        hits = self.scene.trace(self.origins, self.directions)
        self.assertEqual(len(hits), 2000)
        hit = hits["hit"] == 1
        self.assertGreater(hit.sum(), 500)
        self.assertTrue((hits["triangle"][~hit] == -1).all() and np.isinf(hits["t"][~hit]).all())
        point = self.origins + hits["t"][:, None] * self.directions
        for axis, name in enumerate("xyz"):
            np.testing.assert_allclose(point[hit, axis], hits[name][hit], atol=1e-5)
        self.assertTrue((hits["u"][hit] >= 0).all() and (hits["u"] + hits["v"])[hit].max() <= 1)

    def test_all_hits_begin_with_the_nearest(self):
        nearest = self.scene.trace(self.origins, self.directions)
        every = self.scene.trace(self.origins, self.directions, hits="all")
        rays, first = np.unique(every["ray"], return_index=True)
        np.testing.assert_array_equal(rays, nearest["ray"][nearest["hit"] == 1])
        np.testing.assert_array_equal(every["triangle"][first], nearest["triangle"][nearest["hit"] == 1])
        same = np.diff(every["ray"]) == 0
        self.assertTrue((np.diff(every["t"])[same] >= 0).all())

    def test_limits_and_any(self):
        nearest = self.scene.trace(self.origins, self.directions)
        limits = np.full(2000, 0.9)
        any_hit = self.scene.trace(self.origins, self.directions, limits, hits="any")
        np.testing.assert_array_equal(any_hit["hit"] == 1, nearest["t"] < limits)

    def test_takes_float32_and_refuses_what_it_cannot_use(self):
        narrow = self.scene.trace(self.origins.astype(np.float32), self.directions.astype(np.float32), columns=["triangle"])
        self.assertEqual(narrow.dtype.names, ("triangle",))
        for origins, directions, line in (
                ([0, 0, 0], np.ones((4, 4, 3)), r"^directions: found an array of shape \(4, 4, 3\), expected \(N, 3\)$"),
                ([0, 0, 0], [], r"^directions: found an array of shape \(0,\), expected \(N, 3\)$"),
                (np.zeros((2, 3)), [[1, 0, 0], [np.nan, 0, 0]], "ray 1: found inf or nan"),
                (np.zeros((2, 3)), np.ones((3, 3)), r"directions: found an array of shape \(3, 3\), expected \(2, 3\)")):
            with self.assertRaisesRegex(raygate.InputError, line):
                self.scene.trace(origins, directions)
        for wrong, line in (
                ({"hits": "some"}, "hits: found 'some', expected nearest, any or all"),
                ({"hits": "any", "columns": ["t"]},
                 "columns: found 't', expected ray, hit or doubts with hits any"),
                ({"columns": ["t", "t"]}, "columns: found 't', expected each name once"),
                ({"columns": ["tt"]}, "columns: found 'tt', expected some of ray, hit, "),
                ({"columns": "tt"}, "columns: found 'tt', expected some of ray, hit, "),
                ({"columns": 5}, "columns: found 5, expected a name or several names"),
                ({"limits": [1, 2, 3]}, "limits: found an array of shape (3,), expected one number"),
                ({"limits": np.ma.masked_greater([1.0, 9.0], 5)}, "limits: found masked elements"),
                ({"limits": ["a", "b"]}, "limits: found an array of <U1, expected numbers"),
                ({"threads": "two"}, "threads: found 'two', expected a whole number from 1 to 1024"),
                ({"threads": 0}, "threads: found '0', expected a whole number from 1 to 1024")):
            with self.assertRaises(ValueError) as caught:
                self.scene.trace(np.zeros((2, 3)), np.ones((2, 3)), **wrong)
            self.assertEqual(str(caught.exception)[:len(line)], line)
            self.assertNotIn("\n", str(caught.exception))

    def test_triangles_of_an_array(self):
        random = np.random.default_rng(2)
        corners = random.normal(size=(300, 3, 3)).astype(np.float32)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "same.obj"
            file.write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in corners.reshape(-1, 3).tolist()) +
                            "".join(f"f {i} {i + 1} {i + 2}\n" for i in range(1, 900, 3)))
            same = raygate.Scene(file)
        scene = raygate.Scene.of_triangles(corners)
        self.assertEqual(scene.triangle_count, 300)
        hits = [s.trace(self.origins, self.directions, hits="all") for s in (scene, same)]
        self.assertGreater(len(hits[0]), 500)
        self.assertEqual(hits[0].tobytes(), hits[1].tobytes())
        self.assertEqual(scene.render(20, 20)["color"].shape, (20, 20, 4))
        flat = corners.copy()
        flat[7, 2] = flat[7, 1]
        infinite = corners.copy()
        infinite[9, 0, 0] = np.inf
        left = raygate.Scene.of_triangles(flat)
        expected = hits[0][hits[0]["triangle"] != 7]
        self.assertEqual(left.trace(self.origins, self.directions, hits="all").tobytes(), expected.tobytes())
        self.assertEqual(left.warnings, ["triangles[7]: face of zero area, left out"])
        vertices, faces = flat.reshape(-1, 3), np.arange(900).reshape(-1, 3)
        left = raygate.Scene(vertices, faces)
        self.assertEqual(left.triangle_count, 300)
        self.assertEqual(left.trace(self.origins, self.directions, hits="all").tobytes(), expected.tobytes())
        self.assertEqual(left.warnings, ["faces[7]: face of zero area, left out"])
        with self.assertRaisesRegex(ValueError, "no face has an area"):
            raygate.Scene(vertices, faces[7:8])
        for wrong, line in ((infinite, "in triangle 9"),
                            (corners[:0], r"shape \(0, 3, 3\)"), (corners[0], r"shape \(3, 3\)"),
                            ("teapot", "value of type str")):
            with self.assertRaisesRegex(ValueError, line):
                raygate.Scene.of_triangles(wrong)

    def test_no_rays(self):
        none = np.zeros((0, 3))
        self.assertEqual(len(self.scene.trace(none, none)), 0)
        self.assertEqual(len(self.scene.trace(none, [0, 0, 1], hits="all", columns="t")), 0)
        self.assertEqual(len(self.scene.inside(none)) + len(self.scene.closest(none)), 0)
        with self.assertRaisesRegex(ValueError, r"^origins: found an array of shape \(0,\), expected \(N, 3\)$"):
            self.scene.trace([], [])

    def test_one_column(self):
        t = self.scene.trace(self.origins, self.directions, columns="t")
        self.assertEqual(t.dtype.names, ("t",))
        np.testing.assert_array_equal(t["t"], self.scene.trace(self.origins, self.directions)["t"])

    def test_masked_arrays(self):
        masked = np.ma.masked_array(self.origins, np.zeros((2000, 3), bool))
        hits = self.scene.trace(masked, self.directions)
        self.assertEqual(hits.tobytes(), self.scene.trace(self.origins, self.directions).tobytes())
        masked[5] = np.ma.masked
        faces = np.ma.masked_equal([[0, 1, 2]], 2)
        for name, call in (("origins", lambda: self.scene.trace(masked, self.directions)),
                           ("directions", lambda: self.scene.trace([0, 0, 0], masked)),
                           ("points", lambda: self.scene.inside(masked)),
                           ("points", lambda: self.scene.closest(masked)),
                           ("eye", lambda: self.scene.render(8, 8, eye=masked[5])),
                           ("vertices", lambda: raygate.Scene(masked, [[0, 1, 2]])),
                           ("faces", lambda: raygate.Scene(self.origins, faces)),
                           ("operand", lambda: raygate.float.fp_add(masked, 0.0))):
            with self.assertRaisesRegex(ValueError, f"^{name}: found masked elements, expected none"):
                call()


class Pages(unittest.TestCase):
    def test_lines_of_the_tutorial_run(self):
        lines = re.findall(r"```python\n(.*?)```", (SCENES.parent / "host/docs/python.md").read_text(), re.DOTALL)
        self.assertGreater(len(lines), 2)
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
            warnings.simplefilter("ignore", raygate.float.RoundingWarning)
            os.symlink(SCENES, os.path.join(folder, "scenes"))
            os.chdir(folder)
            try:
                exec("\n".join(lines), {})
                self.assertTrue(pathlib.Path("teapot.png").read_bytes().startswith(b"\x89PNG"))
            finally:
                os.chdir(before)


class Arrays(unittest.TestCase):
    """A scene of NumPy arrays, and queries of points."""

    VERTICES = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    FACES = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]

    def setUp(self):
        self.cube = raygate.Scene(self.VERTICES, self.FACES)
        self.points = np.random.default_rng(2).uniform(-2, 2, (3000, 3))

    def test_one_origin_serves_many_directions(self):
        directions = np.random.default_rng(3).normal(size=(50, 3))
        eye = [0.5, 0.25, 0]
        hits = self.cube.trace(eye, directions)
        self.assertTrue((hits["hit"] == 1).all())
        same = self.cube.trace(np.tile(eye, (50, 1)), directions)
        self.assertEqual(hits.tobytes(), same.tobytes())
        self.assertEqual(hits.tobytes(), self.cube.trace([eye], directions).tobytes())
        below = self.cube.trace(self.points, [0, 0, 1], 0.5)
        for one, limits in (([[0, 0, 1]], np.full(3000, 0.5)), (np.tile([0, 0, 1], (3000, 1)), np.float32(0.5))):
            self.assertEqual(self.cube.trace(self.points, one, limits).tobytes(), below.tobytes())
        with self.assertRaisesRegex(ValueError, r"origins: found an array of shape \(2,\)"):
            self.cube.trace([0, 1], directions)

    def test_faces_without_area_are_refused_by_choice(self):
        faces = np.concatenate([self.FACES, [[1, 1, 2]], self.FACES, [[0, 7, 7]]])
        self.assertEqual(raygate.Scene(self.VERTICES, faces).degenerate_faces, [12, 25])
        with self.assertRaisesRegex(raygate.InputError, "^degenerate: found face 12 without area, and 1 more, expected none$"):
            raygate.Scene(self.VERTICES, faces, degenerate="refuse")
        with self.assertRaisesRegex(raygate.InputError, "no face has an area"):
            raygate.Scene.of_triangles(np.ones((1, 3, 3)), degenerate="refuse")
        with self.assertRaisesRegex(raygate.InputError, "degenerate: found 'drop', expected leave out or refuse"):
            raygate.Scene(self.VERTICES, faces, degenerate="drop")

    def test_float64_is_kept(self):
        moved = raygate.Scene(np.array(self.VERTICES) * [0.1, 1, 1] + [5e6, 0, 0], self.FACES)
        side = 5e6 + 0.1
        self.assertEqual(moved.rounding, (0, 0.0))
        xs = np.array([np.nextafter(side, 0), side, np.nextafter(side, 9e9)])
        origins = np.stack([xs, np.full(3, 0.3), np.full(3, 9.0)], -1)
        hits = moved.trace(origins, [0, 0, -1])
        self.assertEqual(hits["hit"].tolist(), [1, 0, 0])  # rays along a side are tilted by infinitesimals towards +x
        np.testing.assert_array_equal(hits["x"][0], xs[0])
        self.assertEqual(moved.inside(origins - [0, 0, 9]).tolist(), [True, False, False])
        tiny = raygate.Scene(np.array(self.VERTICES) * 1e-40, self.FACES)
        self.assertEqual(tiny.rounding[0], 36)  # three corners of each face
        self.assertLess(tiny.rounding[1], 2.0 ** -149)

    def test_counts_rounded_rays(self):
        origins, down = np.random.default_rng(8).uniform(0, 1, (100, 3)), [0, 0, -1]
        for vertices, count in ((self.VERTICES, 0), (np.array(self.VERTICES) + 4096, 100), (np.array(self.VERTICES) * 0.1, 0)):
            scene = raygate.Scene(vertices, self.FACES)
            scene.trace(np.ceil(origins), down)
            self.assertEqual(scene.rounded_rays, 0)
            for hits in ("nearest", "any", "all"):
                scene.trace(origins, down, hits=hits)
            scene.inside(origins)
            self.assertEqual(scene.rounded_rays, 4 * count)

    def test_errors_of_t_and_points(self):
        for middle in (0, 5e6 + 0.1):
            vertices = np.array(self.VERTICES) + middle
            scene = raygate.Scene(vertices, self.FACES)
            origins, directions = self.points * 2 + middle, np.random.default_rng(9).normal(size=(3000, 3))
            hits = scene.trace(origins, directions)
            self.assertGreater((hits["hit"] == 1).sum(), 100)
            whole = np.vectorize(fractions.Fraction, otypes=[object])
            for origin, direction, hit in zip(whole(origins), whole(directions), hits):
                if hit["hit"] == 1:
                    a, b, c = whole(vertices[self.FACES[hit["triangle"]]])
                    normal = np.roll(b - a, -1) * np.roll(c - a, -2) - np.roll(b - a, -2) * np.roll(c - a, -1)
                    t = ((a - origin) @ normal) / (direction @ normal)
                    self.assertLessEqual(abs(hit["t"] - t), 2.0 ** -33 * t)
                    self.assertLessEqual(np.abs([hit[axis] - x for axis, x in zip("xyz", origin + t * direction)]).max(),
                                         2.0 ** -33 * t * np.abs(direction).max() + 2.0 ** -52 * (middle + 9))

    def test_winding_number(self):
        inside = (np.abs(self.points) < 1).all(axis=1)
        winding, errors = self.cube.winding_number(self.points)
        np.testing.assert_array_equal(winding, inside)
        self.assertEqual(errors.max(), 0.0)
        twice = raygate.Scene(np.array(self.VERTICES), np.array(self.FACES * 2))
        np.testing.assert_array_equal(twice.winding_number(self.points)[0], 2 * inside)
        faces = np.array(self.FACES)[[0, 2, 3, 5, 6, 9]]  # of an open surface
        winding, errors = raygate.Scene(np.array(self.VERTICES), faces).winding_number(self.points)
        angles = np.stack([self.solid_angles(np.array(self.VERTICES)[face] - self.points[:, None]) for face in faces], -1)
        np.testing.assert_allclose(winding, angles.sum(-1) / (4 * np.pi), atol=1e-9)
        self.assertLess(errors.max(), 1e-6)

    def test_errors_of_winding_numbers(self):
        square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
        faces = [[0, 1, 2], [0, 2, 3]]
        way = np.array([0.36, 0.48, 0.8], np.float32).astype(float)  # of the rays
        # Rays from these points pass through the open edges, where the solid angle of a strip jumps.
        along, back = np.linspace(0.125, 0.875, 7), np.arange(1, 41)[:, None] / 8
        edges = [square[i] + along[:, None] * (square[(i + 1) % 4] - square[i]) for i in range(4)]
        points = (np.concatenate(edges)[None] - back[:, None] * way).reshape(-1, 3)
        winding, errors = raygate.Scene(square, faces).winding_number(points)
        true = sum(self.solid_angles(square[face] - points[:, None]) for face in faces) / (4 * np.pi)
        self.assertTrue((np.abs(winding - true) <= errors + 1e-12).all())
        # The first point is rounded relative to the scene's origin.
        cube = np.array(self.VERTICES, float)
        vertices = np.concatenate([cube, *(cube + [5e6 + 0.1, 6e6 + 0.1, z] for z in (0, 3, 6, 9))])
        far = raygate.Scene(vertices, np.concatenate([np.array(self.FACES) + i for i in range(0, 40, 8)]))
        winding, errors = far.winding_number([[1 + 1e-11, 0.1, 0.2], [0.1, 0.2, 0.3], [5e6, 6e6, 0.1], [1.5, 0.1, 0.2]])
        self.assertEqual(winding[1:].tolist(), [1, 1, 0])
        self.assertEqual(errors.tolist(), [np.inf, 0, 0, 0])

    @staticmethod
    def solid_angles(corners):
        a, b, c = np.moveaxis(corners, 1, 0)
        size = [np.linalg.norm(corner, axis=-1) for corner in (a, b, c)]
        dot = lambda p, q: (p * q).sum(-1)  # noqa: E731
        return 2 * np.arctan2(dot(a, np.cross(b, c)), size[0] * size[1] * size[2] + dot(a, b) * size[2] + dot(b, c) * size[0] + dot(c, a) * size[1])

    def test_a_wall_in_utm_coordinates(self):
        wall = np.array(self.VERTICES) * [2, 0.04, 1.5] + [447125.456, 5411987.361, 233.289]
        faces = self.FACES + [[8, 9, 10]]  # and a stray face at 0, 0, 0
        scene = raygate.Scene(np.concatenate([wall, [[0, 0, 0], [1, 0, 0], [0, 1, 0]]]), faces)
        self.assertEqual((scene.rounding, scene.warnings), ((0, 0.0), []))
        start = [447125.5, 5411982.321, 233.0]
        hits = scene.trace([start], [[0, 1, 0]], hits="all")
        np.testing.assert_allclose(hits["t"], [5, 5.08], rtol=0, atol=1e-8)
        self.assertEqual(scene.trace([[0.25, 0.25, 1]], [[0, 0, -1]])["triangle"].tolist(), [12])
        self.assertEqual(scene.inside([[447125, 5411987.35, 233], [447125, 5411987.45, 233]]).tolist(), [True, False])
        picture = scene.render(32, 24, eye=start, target=[447125.5, 5411987.361, 233.0], up=[0, 0, 1], fov=20, spp=1)
        self.assertTrue((picture["triangle"] < 12).all())
        np.testing.assert_allclose(picture["depth"], 5, atol=0.2)

    def test_inside(self):
        expected = (np.abs(self.points) < 1).all(axis=1)
        self.assertTrue(expected.any())
        np.testing.assert_array_equal(self.cube.inside(self.points), expected)
        two = raygate.Scene(np.concatenate([self.VERTICES, np.array(self.VERTICES) * 0.9 + 0.5]), np.concatenate([self.FACES, np.array(self.FACES) + 8]))
        second = (np.abs(self.points - 0.5) < 0.9).all(axis=1)
        np.testing.assert_array_equal(two.inside(self.points), expected ^ second)
        np.testing.assert_array_equal(two.winding_number(self.points)[0] != 0, expected | second)

    def test_inside_of_faces_oriented_in_any_way(self):
        way = np.array([0.36, 0.48, 0.8], np.float32).astype(float)  # of the rays
        vertices, faces = np.array(self.VERTICES), np.array(self.FACES)
        points = np.concatenate([self.points, *(vertices - scale * way for scale in (0.125, 0.5, 2))])  # rays through vertices, too
        expected, hollow = (np.abs(points) < 1).all(axis=1), (np.abs(points) < 0.5).all(axis=1)
        whole = np.vectorize(lambda x: int(x * 2 ** 60), otypes=[object])  # whole numbers of any length
        cross = lambda a, b: np.roll(a, -1) * np.roll(b, -2) - np.roll(a, -2) * np.roll(b, -1)  # noqa: E731
        for point, is_inside in list(zip(points, expected))[:300]:
            crossings = 0
            for a, b, c in whole(vertices[faces].astype(float)) - whole(point):
                sides = [cross(p, q) @ whole(way) > 0 for p, q in ((a, b), (b, c), (c, a))]
                crossings += sides == [cross(a, b) @ c > 0] * 3
            self.assertEqual(crossings % 2, is_inside)
        for flipped in range(12):
            turned = np.array([face[::-1] if k == flipped else face for k, face in enumerate(faces)])
            np.testing.assert_array_equal(raygate.Scene(vertices, turned).inside(points), expected)
            shells = np.concatenate([turned, faces[:, ::1 if flipped % 2 else -1] + 8])
            nested = raygate.Scene(np.concatenate([vertices, vertices / 2]), shells)
            np.testing.assert_array_equal(nested.inside(points), expected & ~hollow)

    def test_limits_are_compared_in_float64(self):
        for start in (0.0, 5411943.125):
            walls = np.array([[-1, -1, 0], [3, -1, 0], [-1, 3, 0]]) + [[[start, start, z]] for z in (-1e-9, 0, 1e-9)]
            for order in ([0, 1, 2], [2, 1, 0]):
                scene = raygate.Scene.of_triangles(walls[order])
                for t in (4.0, 2000.0):
                    for limit, count in ((np.nextafter(t, 0), 1), (t, 1), (np.nextafter(t, 9e9), 2), (t + 1e-8, 3), (t - 1e-8, 0)):
                        origin = [start, start, t], [0, 0, -1], limit
                        self.assertEqual(len(scene.trace(*origin, hits="all")), count)
                        self.assertEqual(scene.trace(*origin, hits="any")["hit"], count > 0)
                        self.assertEqual(scene.trace(*origin)["triangle"], order.index(2) if count else -1)

    def test_one_point_and_directions_of_zero(self):
        hits = self.cube.trace([0, 0.1, 5], [0, 0, -2])
        self.assertEqual(hits["t"].tolist(), [2])
        self.assertEqual(self.cube.inside([0, 0.1, 0]).tolist(), [True])
        self.assertEqual(self.cube.closest([0, 0.1, 5])["distance"].tolist(), [4])
        self.assertEqual(self.cube.winding_number([0, 0.1, 0])[0].tolist(), [1])
        for hits in ("nearest", "any", "all"):
            rays = self.cube.trace([0, 0.1, 5], [[0, 0, -1], [0, -0.0, 0]], hits=hits, columns=["ray", "hit"])
            self.assertEqual(rays["hit"].tolist(), [1, 1] if hits == "all" else [1, 0])

    def test_is_shown_as_one_line_and_lists_its_options(self):
        self.assertEqual(repr(self.cube), "<raygate.Scene: 12 triangles, 1 objects, 1 materials>")
        self.assertRegex(repr(self.cube.render(8, 6)), "^<raygate.Picture: 8 x 6 pixels; color, depth, normal, .*>$")
        self.assertIn("ValueError", raygate.InputError.__doc__)
        with self.assertRaisesRegex(raygate.InputError, "unknown option 'ssp', expected some of ") as caught:
            self.cube.render(ssp=4)
        names = set(str(caught.exception).partition("some of ")[2].split(", ")) - {"width", "height"}
        self.assertEqual(names, set(raygate._scene.RenderOptions.__annotations__))
        self.assertLessEqual(names, set(re.findall(r"\w+", raygate.Scene.render.__doc__)))

    def test_inside_beside_faces_along_the_ray(self):
        """Compares inside() with exact integers: tetrahedra with an edge from about 0 along
        inside()'s ray, off by 2^-58, and points near 0."""
        random, along, tiny = np.random.default_rng(5), [0.36, 0.48, 0.8], 2.0 ** -58

        def is_left(a, b, c, points):
            (ax, ay, az), (bx, by, bz) = b - a, c - a
            normal = np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])
            return (points - a) @ normal > 0

        for _ in range(200):
            a, c, d = random.uniform(-0.5, 0.5, (3, 3)) * [[tiny], [1], [1]]
            places = np.float32([a, along, c, d, *random.uniform(-2 * tiny, 2 * tiny, (40, 3))])
            whole = np.vectorize(int, otypes=[object])(places.astype(float) * 2.0 ** 110)
            faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]
            lefts = [is_left(*whole[face], whole[4:]) for face in faces]
            expected = np.all(lefts, axis=0) | ~np.any(lefts, axis=0)
            np.testing.assert_array_equal(raygate.Scene(places[:4], faces).inside(places[4:]), expected)

    def test_closest(self):
        outside = self.points[(np.abs(self.points) > 1).any(axis=1)]
        found = self.cube.closest(outside)
        expected = np.clip(outside, -1, 1)
        for axis, name in enumerate("xyz"):
            np.testing.assert_allclose(found[name], expected[:, axis], atol=1e-15)
        np.testing.assert_allclose(found["distance"], np.linalg.norm(outside - expected, axis=1))
        self.assertTrue(((found["triangle"] >= 0) & (found["triangle"] < 12)).all())

    def test_closest_of_far_points(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(self.cube.closest(np.float32([3e38, 0, 0]))["x"].tolist(), [1])
        for far in (1e9, 1e20, 1e200):
            found = self.cube.closest(far * np.array([[1.0, 0.25, 0.5], [-1, 0, 0]]))
            self.assertEqual(found[["x", "y", "z"]][0].tolist(), (1, 1, 1))
            self.assertEqual(found["x"][1], -1)
            np.testing.assert_allclose(found["distance"], [far * 1.3125 ** 0.5, far], rtol=1e-8)

    def test_a_scene_is_pickled(self):
        rays = self.points, np.random.default_rng(3).normal(size=(3000, 3))
        vertices = np.array(self.VERTICES) * 0.3
        arrays = raygate.Scene(vertices, self.FACES, smooth=100.0)
        corners = np.random.default_rng(4).normal(size=(20, 3, 3))
        triangles = raygate.Scene.of_triangles(corners, threads=1)
        before = os.getcwd()
        os.chdir(SCENES)
        try:
            scenes = [arrays, triangles, raygate.Scene("cornell.obj")]
        finally:
            os.chdir(before)
        kept = [[scene.trace(*rays, hits="all").tobytes(), scene.render(9, 9)["color"].tobytes(), scene.rounding] for scene in scenes]
        vertices += 1  # changes the caller's arrays, not the scenes
        corners += 1
        for scene, expected in zip(scenes, kept):
            again = pickle.loads(pickle.dumps(scene))
            self.assertEqual([again.trace(*rays, hits="all").tobytes(), again.render(9, 9)["color"].tobytes(), again.rounding], expected)

    def test_says_what_it_cannot_use(self):
        for expected, call in (
                ("face 1, expected numbers from 0 to 7",
                 lambda: raygate.Scene(self.VERTICES, [[0, 1, 2], [0, 1, 8]])),
                ("faces: found None", lambda: raygate.Scene(np.zeros((3, 3)))),
                ("^vertices: found a value of type Random, expected numbers$", lambda: raygate.Scene(random.Random())),
                (r"^vertices: found \[0.0, nan, 0.0\] in vertex 1, expected finite",
                 lambda: raygate.Scene([[0, 0, 0], [0, np.nan, 0], [0, 1, 0], [np.nan] * 3], [[0, 1, 2]])),
                ("^width, height: found 9000 x 9000, expected at most", lambda: self.cube.render(9000, 9000)),
                ("^format: found 'str', expected one of Format$", lambda: raygate.float.fp_add(1, 2, "binary16")),
                (r"^faces: found an array of int64 of shape \(0, 3\), expected .*, M > 0$",
                 lambda: raygate.Scene(self.VERTICES, np.zeros((0, 3), int))),
                ("faces: found an array of float64",
                 lambda: raygate.Scene(self.VERTICES, [[0.0, 1.0, 2.0]])),
                (r"points: found \[nan, 0.0, 0.0\] in point 1", lambda: self.cube.inside([[0, 0, 0], [np.nan, 0, 0]])),
                (r"points: found \[inf, 0.0, 0.0\] in point 0", lambda: self.cube.closest([[np.inf, 0, 0]]))):
            with self.assertRaisesRegex(ValueError, expected):
                call()


class Render(unittest.TestCase):
    def test_a_picture(self):
        scene = raygate.Scene(SCENES / "cornell.obj")
        picture = scene.render(40, 30, spp=1, threads=2)
        self.assertEqual(picture["color"].shape, (30, 40, 4))
        self.assertEqual(picture["color"].dtype, np.float32)
        self.assertGreater(picture["color"][..., :3].max(), 0.1)
        np.testing.assert_array_equal(picture["color"][..., 3] == 1, picture["triangle"] != 0xFFFFFFFF)
        again = scene.render(40, 30, spp=1, threads=1)
        for name, channel in picture.items():
            self.assertEqual(channel.tobytes(), again[name].tobytes(), name)

    def test_a_picture_is_saved_and_shown(self):
        picture = raygate.Scene(SCENES / "cornell.obj").render(40, 30, spp=1)
        with tempfile.TemporaryDirectory() as folder:
            for name, start in (("a.png", b"\x89PNG"), ("a.exr", b"\x76\x2f\x31\x01")):
                path = pathlib.Path(folder) / name
                picture.save(path)
                self.assertTrue(path.read_bytes().startswith(start))
            self.assertEqual((pathlib.Path(folder) / "a.png").read_bytes(), picture._repr_png_())
        self.assertNotEqual(picture.png(exposure=1), picture.png())
        with self.assertRaisesRegex(ValueError, "ends in .png or .exr"):
            picture.save("a.jpg")
        self.assertRegex(raygate.__version__, r"^\d+\.\d+\.\d+$")

    def test_a_picture_that_was_interrupted_leaves_no_light(self):
        scene = raygate.Scene(SCENES / "teapot.obj")
        before = scene.render(16, 16, spp=1)["color"]
        raised = signal.signal(signal.SIGALRM, signal.default_int_handler)
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        try:
            with self.assertRaises(KeyboardInterrupt):
                scene.render(2000, 2000, spp=64, eye=[9, 9, 9])
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, raised)
        np.testing.assert_array_equal(scene.render(16, 16, spp=1)["color"], before)

    def test_samples_until_the_error_is_small(self):
        scene = raygate.Scene(SCENES / "cornell.json")
        coarse, fine = (scene.render(16, 12, integrator="path", error=error)["color"] for error in (200, 8))
        self.assertFalse((coarse == fine).all())
        with self.assertRaisesRegex(raygate.InputError, "spp: found '4', expected more than the 16 that adaptive sampling to an error begins with"):
            scene.render(16, 12, spp=4, error=2)

    def test_threads_render_by_their_own_lights(self):
        scene = raygate.Scene(SCENES / "teapot.obj")
        eyes = [[9, 9, 9], [-9, 9, -9]]
        alone = [scene.render(32, 32, spp=4, eye=eye)["color"] for eye in eyes]
        wrong = []

        def render(k):
            for _ in range(20):
                if (scene.render(32, 32, spp=4, eye=eyes[k], threads=1)["color"] != alone[k]).any():
                    wrong.append(k)

        threads = [threading.Thread(target=render, args=[k]) for k in (0, 1)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])

    def test_names_of_any_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(os.fsencode(folder), b"\xff.obj")
            with open(file, "wb") as obj:
                obj.write(b"o a\xfe\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n")
            scene = raygate.Scene(file)
        self.assertEqual(scene.objects[0], os.fsdecode(b"a\xfe"))
        self.assertIn(os.fsdecode(b"\xff.obj"), scene.warnings[0])

    def test_says_what_is_wrong(self):
        for name, line in (("none.obj", "none.obj: cannot read"), (b"\xff.obj", "\udcff.obj: cannot read"),
                           (f"{SCENES}/cornell.obj\0", "without a null byte")):
            with self.assertRaisesRegex(raygate.InputError, line):
                raygate.Scene(name)
        scene = raygate.Scene(SCENES / "cornell.obj")
        for wrong in ({"width": 0}, {"height": 2.5}, {"spp": 0}, {"spp": 2 ** 31 - 1}, {"seed": -1}, {"depth": -1},
                      {"threads": 0}, {"eye": [1, 2]}, {"up": ["a", "b", "c"]}, {"fov": 180},
                      {"target": [[1, 2], [3]]}, {"integrator": "x"}, {"filter": "x"},
                      {"engine": "rtl"}):
            with self.assertRaisesRegex(ValueError, next(iter(wrong))) as caught:
                scene.render(**{"width": 10, "height": 10, **wrong})
            self.assertNotIn("\n", str(caught.exception))


def in_child(work):
    """Returns whether work() returns true in a forked child of this process."""
    child = os.fork()
    if child == 0:
        done = False
        try:
            done = work()
        finally:
            os._exit(0 if done else 1)
    return os.waitpid(child, 0)[1] == 0


class Embedding(unittest.TestCase):
    def setUp(self):
        self.scene = raygate.Scene(SCENES / "teapot.obj")
        random = np.random.default_rng(7)
        self.rays = random.normal(size=(20000, 3)) * 3, random.normal(size=(20000, 3))
        self.hits = self.trace()

    def trace(self):
        return self.scene.trace(*self.rays, threads=2).tobytes()

    def test_threads_trace_at_once(self):
        with concurrent.futures.ThreadPoolExecutor(4) as threads:
            for hits in threads.map(lambda _: self.trace(), range(20)):
                self.assertTrue(hits == self.hits)

    def test_other_threads_go_on(self):
        picture = self.scene.render(1200, 1200)
        points = np.random.default_rng(8).normal(size=(100000, 3))
        corners = np.random.default_rng(9).normal(size=(100000, 3, 3))
        words = np.full(1000000, 0x3F800000, np.uint32)
        for work in (lambda: self.scene.render(300, 300, spp=16, threads=1),
                     lambda: self.scene.closest(points), lambda: self.scene.inside(points),
                     lambda: self.scene.trace(points, [1, 0, 0], hits="all", threads=1),
                     lambda: raygate.Scene.of_triangles(corners),
                     lambda: raygate.float.fp_divide(words, words), picture.png, lambda: picture._film.exr()):
            turns = [time.monotonic()]
            with concurrent.futures.ThreadPoolExecutor(1) as other:
                done = other.submit(work)
                while not done.done():
                    turns.append(time.monotonic())
                turns.append(time.monotonic())
            self.assertLess(np.diff(turns).max(), 0.5 * (turns[-1] - turns[0]) + 0.05)

    def test_far_points_are_found_soon(self):
        directions = np.random.default_rng(8).normal(size=(3000, 3))
        for far in (1e6, 1e30):
            start = time.process_time()
            found = self.scene.closest(far * directions)
            self.assertLess(time.process_time() - start, 3)  # testing every triangle takes 6 s and more
            self.assertTrue((found["distance"] > 1e-3 * far).all())

    def seconds_until_interrupted(self, call, after=0.1):
        """Sends a signal like Ctrl-C's after `after` seconds of processor time. Returns the processor time until `call` ends."""
        raised = signal.signal(signal.SIGPROF, signal.default_int_handler)
        signal.setitimer(signal.ITIMER_PROF, after)
        start = time.process_time()
        try:
            with self.assertRaises(KeyboardInterrupt):
                call()
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
            signal.signal(signal.SIGPROF, raised)
        return time.process_time() - start - after

    def seconds(self, call):
        start = time.process_time()
        call()
        return time.process_time() - start

    def test_ctrl_c_ends_endless_calls(self):
        # All points of the sphere are equally near its middle, so each search tests all triangles.
        u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 300), np.linspace(0.01, 3.1, 300))
        sphere = np.stack([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)], axis=-1)
        quads = [sphere[:-1, :-1], sphere[1:, :-1], sphere[1:, 1:]]
        closed = raygate.Scene.of_triangles(np.stack(quads, axis=2).reshape(-1, 3, 3))
        layers = np.tile([[[-1, -1, 0], [1, -1, 0], [0, 1, 0]]], (2000, 1, 1)) + np.arange(2000)[:, None, None] * [0, 0, 1]
        stack = raygate.Scene.of_triangles(layers)
        rays = np.zeros((1000000, 3))
        for call in (lambda: closed.closest(rays),
                     lambda: stack.trace([0, 0, -1], rays + [0, 0, 1], hits="all", columns="ray"),
                     lambda: self.scene.render(2000, 2000, spp=1000)):
            self.assertLess(self.seconds_until_interrupted(call), 20)  # else it never ends

    def test_ctrl_c_ends_long_calls(self):
        count = 500000
        corners = np.random.default_rng(9).normal(size=(count, 1, 3)) + np.eye(3) * 0.01
        words = np.full(3000000, 0x3F800000, np.uint32)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "many.obj"
            file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + count * "f 1 2 3\n")
            for call in (lambda: raygate.Scene.of_triangles(corners, threads=2), lambda: raygate.Scene(file),
                         lambda: raygate.float.fp_divide(words, words)):
                whole = min(self.seconds(call), self.seconds(call))
                # A call that cannot be interrupted takes three quarters of its time after the signal.
                self.assertLess(self.seconds_until_interrupted(call, after=0.25 * whole), 0.5 * whole)

    def test_works_in_a_child(self):
        self.assertTrue(in_child(lambda: self.trace() == self.hits))
        self.assertTrue(in_child(lambda: raygate.Scene(SCENES / "teapot.obj").triangle_count > 0))

    def test_no_memory(self):
        def falls_short():
            with open("/proc/self/statm") as sizes:
                taken = int(sizes.read().split()[0]) * resource.getpagesize()
            resource.setrlimit(resource.RLIMIT_AS, (taken + (512 << 20), resource.RLIM_INFINITY))
            try:
                self.scene.render(8000, 8000, spp=1, threads=1)
            except MemoryError:
                return self.trace() == self.hits
            return False

        self.assertTrue(in_child(falls_short))


@unittest.skipUnless(platform.machine() == "x86_64", "MXCSR is x86's")
class StateOfTheThread(unittest.TestCase):
    """Arithmetic settings of other modules change no result, and are restored afterwards."""

    TRAPS = 0x1F80  # masked where 1
    CHANGES = [(0x0800, 0x4000),  # rounding upward
               (0, 0x8000), (0, 0x0040)]  # subnormal results, and operands, count as 0
    libm = ctypes.CDLL(None)

    def state(self):
        """fenv_t: its first word has x87's control word, the last one is MXCSR."""
        words = np.zeros(8, np.uint32)
        self.libm.fegetenv(words.ctypes)
        return words

    def expect_the_same(self, answers):
        usual = self.state()
        expected = answers()
        states = []
        for control, mxcsr in self.CHANGES:
            states.append(usual.copy())
            states[-1][[0, 7]] |= np.uint32([control, mxcsr])
        states.append(usual.copy())
        states[-1][7] &= ~np.uint32(self.TRAPS | 0x3F)
        for state in states:
            self.libm.fesetenv(state.ctypes)
            try:
                found, left = answers(), self.state()
            finally:
                self.libm.fesetenv(usual.ctypes)
            self.assertTrue(found == expected, hex(state[7]))
            np.testing.assert_array_equal(left, state)

    def test_changes_no_hit(self):
        random = np.random.default_rng(5)
        corners = (random.normal(size=(5000, 1, 3)) + 0.2 * random.normal(size=(5000, 3, 3))) * 1e-40
        origins, directions = random.normal(size=(2, 3000, 3))
        origins *= 1e-40

        def answers():
            scene = raygate.Scene.of_triangles(corners, threads=2)
            return scene.trace(origins, directions, threads=2).tobytes()

        self.expect_the_same(answers)

    def test_changes_no_picture(self):
        def answers():
            scene = raygate.Scene(SCENES / "teapot.obj", smooth=33.3)
            return scene.render(16, 16, spp=2, fov=37.1, threads=2)["color"].tobytes()

        self.expect_the_same(answers)

    def test_changes_no_float(self):
        numbers = np.random.default_rng(6).integers(0, 0x7F800000, 1000, np.uint32).view(np.float32)

        def answers():
            result = raygate.float.fp_multiply(numbers, numbers[::-1])
            narrow = raygate.float.round_to(numbers, raygate.float.BINARY16)
            return [array.tobytes() for array in (*result, *narrow)]

        self.expect_the_same(answers)


if __name__ == "__main__":
    unittest.main()
