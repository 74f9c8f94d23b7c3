"""Wrong answers and time beside libigl and Embree, for models in binary64 that packages carry, and the time of pictures of
awkward scenes: `make test LONG=binary64`.

Prints tables. Fails if an answer of raygate is wrong. Truth: signs of determinants in binary64 where an error bound leaves
no doubt, else in rational numbers.
"""

import fractions
import importlib.util
import pathlib
import time
import unittest

import igl
import igl.embree
import numpy as np
import trimesh

import raygate

RAYS = 1000
UTM = np.array([448251.75, 5411943.125, 271.3125])  # easting, northing, height


def of_package(package, file):
    return pathlib.Path(importlib.util.find_spec(package).origin).parent / file


def part(file):
    """A part of a robot in millimetres, as CAD exports it, turned and put into a hall."""
    mesh = trimesh.load(of_package("gymnasium_robotics", "envs/assets/" + file), process=True)
    turn = trimesh.transformations.rotation_matrix(0.3, [1, 2, 3])[:3, :3]
    return 1000 * mesh.vertices @ turn.T + [12000.5, -3500.25, 800.125], mesh.faces


def terrain():
    """A survey: heights near Jacksboro, Tennessee, in metres east and north."""
    data = np.load(of_package("matplotlib", "mpl-data/sample_data/jacksboro_fault_dem.npz"))
    heights = data["elevation"][::2, ::2].astype(float)
    y, x = np.indices(heights.shape) * 2 * np.array([data["dy"] * 110958.98, data["dx"] * 89700.51]).reshape(2, 1, 1)
    return grid(x, y, heights, UTM)


def grid(x, y, z, corner):
    """The triangles between neighbouring points of a grid."""
    number = np.arange(x.size).reshape(x.shape)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    return np.stack([x, y, z], axis=-1).reshape(-1, 3) + corner, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def truth(origin, direction, corners):
    """Returns the faces that a ray meets, nearest first, by definition; [-1] if the ray meets an edge or starts in a face's plane."""
    a, b, c = np.moveaxis(corners - origin, 1, 0)
    found = np.ones(len(corners), bool)
    d = np.einsum("ij,ij->i", a, np.cross(b, c))
    # A . (B x C) and I . (A x B), with I the direction and A, B, C the corners, are six terms with at most ten roundings of 2^-53 each.
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
        """Prints the table rows of one model. Half of the rays aim at edges."""
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
            return [hit[0] for hit in embree.intersectRay(origin.astype(np.float32), direction.astype(np.float32))[0]]

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


def sheet(rows, columns, size, corner=UTM):
    """A hilly sheet of 2 (rows - 1) (columns - 1) triangles."""
    y, x = np.mgrid[0:size:rows * 1j, 0:size:columns * 1j]
    return grid(x, y, np.sin(6 * x / size) + np.cos(9 * y / size), corner)


def fan(count):
    """Triangles around one vertex."""
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    rim = np.stack([15 * np.cos(angle), 15 * np.sin(angle), np.sin(7 * angle)], axis=1)
    faces = np.stack([np.zeros(count, int), 1 + np.arange(count), 1 + (np.arange(count) + 1) % count], axis=1)
    return UTM + [15, 15, 0] + np.concatenate([[[0, 0, 0]], rim]), faces


def together(*meshes):
    """One mesh of several."""
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in meshes])
    return np.concatenate([mesh[0] for mesh in meshes]), np.concatenate([mesh[1] + start for mesh, start in zip(meshes, starts)])


class AwkwardScenes(unittest.TestCase):
    def test_time_of_a_picture(self):
        plain, stray = sheet(60, 60, 30), (np.eye(3), np.array([[0, 1, 2]]))
        scenes = {"a stray triangle at 0, 0, 0": (together(plain, stray), plain),
                  "30 m in 6,000 km": (together(plain, sheet(3, 3, 6e6)), plain),
                  "4,000 triangles on 4,000": (together(*[sheet(2, 2, 30)] * 2000), sheet(46, 46, 30)),
                  "needles, 600 times as long as wide": (sheet(6, 600, 30), sheet(60, 60, 30)),
                  "100,000 triangles at a vertex": (fan(100_000), sheet(225, 225, 30))}
        print("\n| scene | seconds | of a usual scene as large | ratio | of Embree's camera rays |\n|---|---:|---:|---:|---:|")
        for name, meshes in scenes.items():
            ours, usual = (self.seconds_of_picture(mesh) for mesh in meshes)
            peer, usual_peer = (self.seconds_of_embree(mesh) for mesh in meshes)
            print(f"| {name} | {ours:.2f} | {usual:.2f} | {ours / usual:.1f} | {peer / usual_peer:.1f} |")

    def seconds_of_picture(self, mesh):
        scene, start = raygate.Scene(*mesh), time.process_time()
        picture = scene.render(160, 120, eye=UTM + [15, -10, 15], target=UTM + [15, 15, 0], up=[0, 0, 1], spp=4)
        self.assertGreater(np.count_nonzero(picture["color"][..., :3].max(axis=2)), 5000)
        return time.process_time() - start

    def seconds_of_embree(self, mesh):
        rays = trimesh.Trimesh(mesh[0] - UTM, mesh[1], process=False).ray
        origins = np.tile([15.0, -10.0, 15.0], (160 * 120, 1))
        directions = np.pad(np.random.default_rng(1).uniform(0, 30, (len(origins), 2)), ((0, 0), (0, 1))) - origins
        rays.intersects_first(origins[:1], directions[:1])  # builds its tree
        start = time.process_time()
        rays.intersects_first(origins, directions)
        return time.process_time() - start


if __name__ == "__main__":
    unittest.main()
