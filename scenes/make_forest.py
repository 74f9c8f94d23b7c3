#!/usr/bin/env python3
"""Writes a forest: one tree as OBJ and MTL, hilly ground, and a scene file with the tree's places.

OUTPUT.obj is the ground, OUTPUT_tree.obj the tree, OUTPUT.json the scene: by default 10,000
instances of 100,000 triangles. A tree's branches are prisms that fork at random. All other
triangles of the tree are leaves of two triangles each.
"""
import argparse
import json
import math
import pathlib
import random

import making

GROUND = """\
newmtl ground
Kd 0.3 0.26 0.14
illum 1
"""
TREE = """\
newmtl bark
Kd 0.28 0.2 0.13
illum 1

newmtl leaf
Kd 0.2 0.42 0.08
illum 1
"""
SIDES = 6  # number of sides of a branch
SPACE = 7.0  # metres from tree to tree


def add(a, b, scale=1.0):
    return [x + scale * y for x, y in zip(a, b)]


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return [x / length for x in a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def frame(along):
    """Returns two unit vectors perpendicular to the unit vector `along` and to each other."""
    across = unit(cross(along, [1, 0, 0] if abs(along[0]) < 0.7 else [0, 0, 1]))
    return across, cross(along, across)


class Tree:
    """A tree's vertices, its faces by material, and the twigs that leaves grow on."""

    def __init__(self, rng):
        self.rng = rng
        self.vertices, self.wood, self.leaves, self.twigs = [], [], [], []

    def ring(self, centre, along, radius):
        u, v = frame(along)
        first = len(self.vertices) + 1
        for i in range(SIDES):
            angle = 2 * math.pi * i / SIDES
            self.vertices.append(add(add(centre, u, radius * math.cos(angle)), v,
                                     radius * math.sin(angle)))
        return first

    def branch(self, start, along, length, radius, level):
        """Adds a bent prism that becomes thinner, and the branches that begin on this prism."""
        rng, parts = self.rng, 4 if level == 0 else 2
        below, at = self.ring(start, along, radius), start
        for part in range(parts):
            along = unit([x + rng.uniform(-0.12, 0.12) for x in along])
            along = unit(add(along, [0, 1, 0], 0.06))
            at = add(at, along, length / parts)
            thin = radius * (1 - 0.8 * (part + 1) / parts)
            above = self.ring(at, along, thin)
            for i in range(SIDES):
                j = (i + 1) % SIDES
                self.wood.append((below + i, below + j, above + j))
                self.wood.append((below + i, above + j, above + i))
            below = above
            if level == 3:
                self.twigs.append((at, along))
                continue
            if level == 0 and part == 0:
                continue
            for _ in range((7, 5, 4)[level]):
                u, v = frame(along)
                turn, lean = rng.uniform(0, 2 * math.pi), rng.uniform(0.6, 1.15)
                out = add([math.cos(turn) * x for x in u], v, math.sin(turn))
                way = add([math.cos(lean) * x for x in along], out, math.sin(lean))
                root = add(at, along, -rng.uniform(0, length / parts))
                size = (0.42, 0.5, 0.5)[level] * rng.uniform(0.7, 1.2) * (1.15 - 0.5 * part / parts)
                self.branch(root, unit(way), size * length, 0.45 * thin + 0.004, level + 1)

    def leaf(self):
        rng = self.rng
        at, along = rng.choice(self.twigs)
        way = unit([x + rng.uniform(-1, 1) for x in along])
        across, up = frame(way)
        turn, size = rng.uniform(0, 2 * math.pi), rng.uniform(0.07, 0.13)
        across = add([math.cos(turn) * x for x in across], up, math.sin(turn))
        begin = add(at, [rng.uniform(-0.14, 0.14) for _ in range(3)])
        middle, first = add(begin, way, 0.5 * size), len(self.vertices) + 1
        self.vertices += [begin, add(middle, across, 0.3 * size), add(begin, way, size),
                          add(middle, across, -0.3 * size)]
        self.leaves += [(first, first + 1, first + 2), (first, first + 2, first + 3)]


def make_tree(triangles, rng):
    tree = Tree(rng)
    tree.branch([0.0, -0.3, 0.0], [0.0, 1.0, 0.0], 9.0, 0.24, 0)
    while len(tree.wood) + len(tree.leaves) < triangles:
        tree.leaf()
    tree.wood = tree.wood[:triangles]
    return tree


def height(x, z):
    return (9 * math.sin(x / 61 + 1) * math.cos(z / 73) + 4 * math.sin(x / 23 - z / 31)
            + 22 * math.sin(z / 190 + 2) * math.cos(x / 230))


def above(x, z, metres):
    return [round(x, 3), round(height(x, z) + metres, 3), round(z, 3)]


def write_tree(path, tree):
    path.with_suffix(".mtl").write_text(TREE, encoding="ascii")
    with open(path, "w", encoding="ascii") as file:
        count = len(tree.wood) + len(tree.leaves)
        file.write(f"# A tree of {count} triangles: make_forest.py\n"
                   f"mtllib {path.with_suffix('.mtl').name}\no tree\n")
        file.writelines("v %.6g %.6g %.6g\n" % tuple(vertex) for vertex in tree.vertices)
        for material, faces in (("bark", tree.wood), ("leaf", tree.leaves)):
            file.write(f"usemtl {material}\n")
            file.writelines("f %d %d %d\n" % face for face in faces)


def write_ground(path, side, cells):
    path.with_suffix(".mtl").write_text(GROUND, encoding="ascii")
    with open(path, "w", encoding="ascii") as file:
        file.write(f"# Ground of {2 * cells * cells} triangles: make_forest.py\n"
                   f"mtllib {path.with_suffix('.mtl').name}\no ground\nusemtl ground\n")
        for j in range(cells + 1):
            for i in range(cells + 1):
                x, z = side * (i / cells - 0.5), side * (j / cells - 0.5)
                file.write(f"v {x:.6g} {height(x, z):.6g} {z:.6g}\n")
        for j in range(cells):
            for i in range(cells):
                a = j * (cells + 1) + i + 1
                b = a + cells + 1
                file.write(f"f {a} {b} {b + 1}\nf {a} {b + 1} {a + 1}\n")


def places(count, rng):
    """Yields the trees' matrices, by rows. Trees are turned, slightly stretched and leaning, on a randomly disturbed grid."""
    side = math.ceil(math.sqrt(count))
    for i in range(count):
        x = SPACE * (i % side - 0.5 * (side - 1) + rng.uniform(-0.4, 0.4))
        z = SPACE * (i // side - 0.5 * (side - 1) + rng.uniform(-0.4, 0.4))
        turn, wide, high = rng.uniform(0, 2 * math.pi), rng.uniform(0.8, 1.25), rng.uniform(0.7, 1.4)
        c, s = wide * math.cos(turn), wide * math.sin(turn)
        lean = [rng.uniform(-0.06, 0.06) * high for _ in range(2)]
        yield [c, lean[0], s, x, 0.0, high, 0.0, height(x, z), -s, lean[1], c, z]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", type=pathlib.Path, help="the ground's OBJ; all else beside it")
    parser.add_argument("--trees", type=making.at_least(1), default=10_000)
    parser.add_argument("--triangles", type=making.at_least(2), default=100_000, help="of a tree; even")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()

    rng = random.Random(options.seed)
    tree = options.output.with_name(options.output.stem + "_tree.obj")
    write_tree(tree, make_tree(options.triangles, rng))
    side = SPACE * (math.ceil(math.sqrt(options.trees)) + 40)
    write_ground(options.output, side, 160)
    edge = 0.5 * SPACE * math.ceil(math.sqrt(options.trees))
    scene = {
        "obj": options.output.name,
        "camera": {"eye": above(0.2 * edge, edge + 35, 13), "target": above(0.03 * edge, edge - 40, 6),
                   "fov": 45},
        "directional_lights": [{"direction": [-0.6, -0.75, -0.2], "irradiance": [3.2, 2.9, 2.4]}],
        "background": [0.42, 0.56, 0.8],
        "render": {"size": "960x540", "integrator": "path", "depth": 4},
    }
    text = ",\n".join(f' "{key}": {json.dumps(value)}' for key, value in scene.items())
    rows = ",\n".join(json.dumps([round(x, 6) for x in place])
                      for place in places(options.trees, rng))
    options.output.with_suffix(".json").write_text(
        "{\n" + text + ',\n "instances": [{"model": "' + tree.name + '", "places": [\n' + rows + "]}]\n}\n",
        encoding="ascii")


if __name__ == "__main__":
    making.run(main)
