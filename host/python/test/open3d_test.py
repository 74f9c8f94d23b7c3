"""raygate.open3d gives the answers that Open3D's documentation promises, on a cube and a floor."""

import itertools
import unittest
import unittest.mock

import numpy as np

import raygate
from raygate.open3d import RaycastingScene

VERTICES = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
FACES = np.array([[0, 1, 3], [0, 3, 2], [4, 7, 5], [4, 6, 7], [0, 5, 1], [0, 4, 5], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 7, 3], [1, 5, 7]])


class Queries(unittest.TestCase):
    def setUp(self):
        self.scene = RaycastingScene()
        self.assertEqual(self.scene.add_triangles(VERTICES, FACES.astype(np.uint32)), 0)
        self.assertEqual(self.scene.add_triangles([[-9, -9, -4], [9, -9, -4], [0, 9, -4]], [[0, 1, 2]]), 1)

    def test_cast_rays(self):
        rays = np.array([[[0.25, 0.5, 5, 0, 0, -2], [3, 0, 5, 0, 0, -1]], [[0, 0, 0, 0, 0, -1], [50, 0, 0, 0, 0, 1]]])
        found = self.scene.cast_rays(rays)
        np.testing.assert_array_equal(found["t_hit"], [[2, 9], [1, np.inf]])
        np.testing.assert_array_equal(found["geometry_ids"], [[0, 1], [0, RaycastingScene.INVALID_ID]])
        self.assertEqual(found["primitive_ids"][0, 1], 0)
        np.testing.assert_array_equal(found["primitive_normals"], [[[0, 0, 1]] * 2, [[0, 0, -1], [0, 0, 0]]])
        u, v = found["primitive_uvs"][0, 0]
        a, b, c = VERTICES[FACES[found["primitive_ids"][0, 0]]]
        np.testing.assert_allclose((1 - u - v) * a + u * b + v * c, [0.25, 0.5, 1])

    def test_occlusions(self):
        rays = [[0, 0, 5, 0, 0, -1]] * 2 + [[0, 0, 5, 0, 0, 1]]
        np.testing.assert_array_equal(self.scene.test_occlusions(rays), [True, True, False])
        for near, far, hit in ((0, 3, False), (0, 4.5, True), (4.5, 5.5, False), (4.5, 6.5, True), (9.5, np.inf, False)):
            self.assertEqual(self.scene.test_occlusions(rays[:1], near, far).tolist(), [hit], (near, far))

    def test_all_intersections(self):
        rays = [[0.1, 0.2, 5, 0, 0, -1], [50, 0, 0, 0, 0, 1], [-1, -1, 5, 0, 0, -1], [0, 0, 5, 0, 0, -1]]
        counts = self.scene.count_intersections(rays)
        self.assertEqual(counts[:2].tolist(), [3, 0])
        self.assertEqual(counts[3], 3, "the diagonals of two sides are crossed once each")
        found = self.scene.list_intersections(rays)
        np.testing.assert_array_equal(np.diff(found["ray_splits"].astype(int)), counts)
        np.testing.assert_array_equal(found["t_hit"][:3], [4, 6, 9])
        np.testing.assert_array_equal(found["geometry_ids"][:3], [0, 0, 1])

    def test_points(self):
        points = np.array([[[0, 0, 0.5], [0, 0, 2.5]]])
        found = self.scene.compute_closest_points(points)
        np.testing.assert_allclose(found["points"], [[[0, 0, 1], [0, 0, 1]]])
        np.testing.assert_allclose(found["primitive_normals"], [[[0, 0, 1], [0, 0, 1]]])
        u, v = np.moveaxis(found["primitive_uvs"], -1, 0)[..., None]
        a, b, c = np.moveaxis(VERTICES[FACES[found["primitive_ids"]]], -2, 0)
        np.testing.assert_allclose((1 - u - v) * a + u * b + v * c, found["points"], atol=1e-12)
        np.testing.assert_allclose(self.scene.compute_distance(points), [[0.5, 1.5]])
        closed = RaycastingScene()
        closed.add_triangles(VERTICES, FACES)
        np.testing.assert_allclose(closed.compute_signed_distance(points), [[-0.5, 1.5]])
        np.testing.assert_array_equal(closed.compute_occupancy(points), [[1, 0]])

    def test_refuses(self):
        with self.assertRaisesRegex(raygate.InputError, "without triangles"):
            RaycastingScene().cast_rays([[0, 0, 0, 0, 0, 1]])
        for what, call in (
                ("rays: found an array of shape (1, 3), expected (..., N, 6)", lambda: self.scene.cast_rays([[0, 0, 0]])),
                ("rays: found an array of shape (6,), expected (..., N, 6)", lambda: self.scene.cast_rays([0, 0, 5, 0, 0, -1])),
                ("rays: found an array of <U1, expected numbers", lambda: self.scene.cast_rays([["0"] * 6])),
                ("query_points: found an array of shape (2,), expected", lambda: self.scene.compute_distance([0, 1])),
                ("nthreads: found -1, expected a whole number from 0", lambda: self.scene.cast_rays([[0, 0, 5, 0, 0, -1]], -1)),
                ("nthreads: found 1.5, expected", lambda: self.scene.compute_distance([[0, 0, 0]], 1.5)),
                ("nthreads: found 'all', expected", lambda: RaycastingScene("all")),
                ("nsamples: found 2, expected an odd", lambda: self.scene.compute_occupancy([[0, 0, 0]], nsamples=2)),
                ("nsamples: found 0, expected an odd", lambda: self.scene.compute_signed_distance([[0, 0, 0]], nsamples=0)),
                ("vertex_positions: found an array of shape (8, 2), expected (N, 3)",
                 lambda: self.scene.add_triangles(VERTICES[:, :2], FACES)),
                ("vertex_positions: found [inf, 0.0, 0.0] in vertex 1",
                 lambda: self.scene.add_triangles([[0, 0, 0], [np.inf, 0, 0], [0, 1, 0]], [[0, 1, 2]])),
                ("triangle_indices: found [0, 1, 8] in face 0, expected numbers from 0 to 7",
                 lambda: self.scene.add_triangles(VERTICES, [[0, 1, 8]])),
                ("triangle_indices: found [0, 1, -1] in face 0", lambda: self.scene.add_triangles(VERTICES, [[0, 1, -1]])),
                ("triangle_indices: found an array of float64", lambda: self.scene.add_triangles(VERTICES, FACES * 1.0))):
            with self.subTest(what), self.assertRaises(raygate.InputError) as refused:
                call()
            self.assertIn(what, str(refused.exception))
        self.assertEqual(self.scene.add_triangles(VERTICES + 20, FACES), 2, "what was refused has no number")

    def test_takes_as_many_threads_as_asked(self):
        asked = []
        trace = raygate.Scene.trace
        rays = [[0, 0, 5, 0, 0, -1]]
        with unittest.mock.patch.object(raygate.Scene, "trace", autospec=True, side_effect=lambda *arguments, **options: (
                asked.append(options["threads"]), trace(*arguments, **options))[1]):
            for query in (self.scene.cast_rays, self.scene.test_occlusions, self.scene.count_intersections,
                          self.scene.list_intersections):
                query(rays, nthreads=3)
            self.scene.compute_occupancy([[0, 0, 0]], 3)
            self.scene.compute_signed_distance([[0, 0, 0]], 3)
            self.scene.cast_rays(rays)
        self.assertEqual(asked, [3] * 6 + [None])

    def test_a_surface_in_another_is_a_hole(self):
        hollow = RaycastingScene()
        hollow.add_triangles(VERTICES, FACES)
        hollow.add_triangles(VERTICES / 2, FACES)
        np.testing.assert_array_equal(hollow.compute_occupancy([[0, 0, 0], [0, 0, 0.75], [0, 0, 2]]), [0, 1, 0])
        self.assertEqual(hollow.test_occlusions([[0, 0, 5, 0, 0, -1]], 1, 1).tolist(), [False])


if __name__ == "__main__":
    unittest.main()
