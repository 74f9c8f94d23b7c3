"""Wrong answers and time beside libigl and Embree, for models in binary64 that packages carry: `make test LONG=binary64`.

Prints a table. Fails if an answer of raygate is wrong. Truth: signs of determinants in binary64 where an error bound leaves
no doubt, else in rational numbers.
"""

import fractions
import importlib.resources
import time
import unittest

import igl
import igl.embree
import numpy as np
import trimesh

import raygate

RAYS = 1000
UTM = np.array([448251.75, 5411943.125, 271.3125])  # easting, northing, height


def part(file):
    """A part of a robot, as CAD exports it, turned and put where it stands."""
    folder = importlib.resources.files("gymnasium_robotics") / "envs/assets"
    mesh = trimesh.load(folder / file, process=True)
    turn = trimesh.transformations.rotation_matrix(0.3, [1, 2, 3])[:3, :3]
    return mesh.vertices @ turn.T + UTM, mesh.faces


def terrain():
    """A survey: heights near Jacksboro, Tennessee, in metres east and north."""
    data = np.load(importlib.resources.files("matplotlib") / "mpl-data/sample_data/jacksboro_fault_dem.npz")
    heights = data["elevation"][::2, ::2].astype(float)
    rows, columns = heights.shape
    y, x = np.mgrid[0:rows, 0:columns] * 2 * np.array([data["dy"] * 110958.98, data["dx"] * 89700.51]).reshape(2, 1, 1)
    corner = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (part.ravel() for part in (corner[:-1, :-1], corner[:-1, 1:], corner[1:, 1:], corner[1:, :-1]))
    return np.stack([x, y, heights], axis=-1).reshape(-1, 3) + UTM, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def truth(origin, direction, corners):
    """The faces that a ray meets, nearest first, by definition: -1 in their place where it meets an edge or a plane exactly."""
    a, b, c = np.moveaxis(corners - origin, 1, 0)
    found = np.ones(len(corners), bool)
    d = np.einsum("ij,ij->i", a, np.cross(b, c))
    # A . (B x C) and I . (A x B) are six terms with at most ten roundings of 2^-53 each.
    size = np.abs(corners - origin).max(axis=(1, 2))
    sure_d = np.abs(d) > 2.0**-46 * size**3
    sides = [np.cross(p, q) @ direction for p, q in ((a, b), (b, c), (c, a))]
    for side in sides:
        sure = np.abs(side) > 2.0**-46 * size**2 * np.abs(direction).max()
        found &= ~(sure & sure_d) | (np.sign(side) == np.sign(d))
    exact = [fractions.Fraction(x) for x in direction.tolist()]
    start = [fractions.Fraction(x) for x in origin.tolist()]
    hits = []
    for face in np.flatnonzero(found):
        p, q, r = ([fractions.Fraction(x) - o for x, o in zip(corner, start)] for corner in corners[face].tolist())
        volume, edges = dot(p, cross(q, r)), [dot(exact, cross(*pair)) for pair in ((p, q), (q, r), (r, p))]
        if any(edge * volume < 0 for edge in edges):
            continue
        if volume == 0 or 0 in edges:
            return [-1]
        hits.append((volume / sum(edges), int(face)))
    return [face for _, face in sorted(hits)]


def cross(p, q):
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]


def dot(p, q):
    return sum(x * y for x, y in zip(p, q))


class Peers(unittest.TestCase):
    def test_wrong_answers_and_time(self):
        print("\n| model | triangles | by | wrong nearest face | wrong number of hits | us a ray |\n|---|---:|---|---:|---:|---:|")
        for name, (vertices, faces) in {"Franka link 6": part("kitchen_franka/franka_assets/meshes/visual/link6.stl"),
                                        "forearm": part("stls/hand/forearm_electric.stl"), "Jacksboro": terrain()}.items():
            self.compare(name, np.ascontiguousarray(vertices, float), np.ascontiguousarray(faces, np.int64))

    def compare(self, name, vertices, faces):
        """Prints the rows of a model. Half of the rays aim at edges."""
        random, corners = np.random.default_rng(1), vertices[faces]
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        origins = low + (high - low) * random.uniform(-0.5, 1.5, (RAYS, 3))
        aim = corners[random.integers(0, len(faces), RAYS)]
        weights = random.dirichlet([1, 1, 1], RAYS) * np.where(np.arange(RAYS)[:, None] % 2, 1, [1, 1, 0])
        targets = np.einsum("ij,ijk->ik", weights / weights.sum(axis=1, keepdims=True), aim)
        directions = targets - origins
        right = [truth(*ray, corners) for ray in zip(origins, directions)]
        scene = raygate.Scene(vertices, faces)
        embree = igl.embree.EmbreeIntersector()
        embree.init(vertices.astype(np.float32), faces.astype(np.int32))

        def of_igl(origin, direction):
            return [hit[0] for hit in igl.ray_mesh_intersect(origin, direction, vertices, faces) or ()]

        def of_embree(origin, direction):
            return [hit[0] for hit in embree.intersectRay_all(origin.astype(np.float32), direction.astype(np.float32))]

        def by_ray(trace):
            return lambda: [trace(*ray) for ray in zip(origins, directions)]

        def of_raygate():
            hits = scene.trace(origins, directions, hits="all", columns=["ray", "triangle"])
            return [part.tolist() for part in np.split(hits["triangle"], np.searchsorted(hits["ray"], np.arange(1, RAYS)))]

        for by, trace in {"raygate": of_raygate, "libigl, binary64": by_ray(of_igl), "Embree by libigl": by_ray(of_embree)}.items():
            start = time.process_time()
            answers = trace()
            took = 1e6 * (time.process_time() - start) / RAYS
            pairs = [(mine, exact) for mine, exact in zip(answers, right) if exact != [-1]]
            nearest = sum(mine[:1] != exact[:1] for mine, exact in pairs)
            number = sum(len(mine) != len(exact) for mine, exact in pairs)
            print(f"| {name} | {len(faces):,} | {by} | {nearest} of {len(pairs):,} | {number} | {took:.1f} |")
            self.assertTrue(by != "raygate" or nearest + number == 0)


if __name__ == "__main__":
    unittest.main()
