#!/usr/bin/env python3
"""Writes a closed sphere as OBJ: an icosahedron whose triangles are cut in four, again and again.

Vertices are shared, so the mesh is watertight. It has 20 * 4**fineness triangles.
"""
import argparse
import math

import making


def icosphere(fineness):
    """Returns the vertices of the unit sphere, and its triangles as vertex indices from 0, counter-clockwise from outside."""
    golden = (1 + math.sqrt(5)) / 2
    # The corners of three golden rectangles.
    vertices = []
    for a in (-1, 1):
        for b in (-golden, golden):
            vertices += [(a, b, 0), (0, a, b), (b, 0, a)]
    vertices = [unit(v) for v in vertices]
    edge = min(math.dist(vertices[0], v) for v in vertices[1:]) * 1.01
    triangles = []
    for i in range(12):
        for j in range(i + 1, 12):
            for k in range(j + 1, 12):
                a, b, c = vertices[i], vertices[j], vertices[k]
                if max(math.dist(a, b), math.dist(b, c), math.dist(c, a)) < edge:
                    triangles.append((i, j, k) if faces_outwards(a, b, c) else (i, k, j))

    for _ in range(fineness):
        middles = {}

        def middle(i, j):
            key = (min(i, j), max(i, j))
            if key not in middles:
                middles[key] = len(vertices)
                vertices.append(unit([p + q for p, q in zip(vertices[i], vertices[j])]))
            return middles[key]

        finer = []
        for i, j, k in triangles:
            ij, jk, ki = middle(i, j), middle(j, k), middle(k, i)
            finer += [(i, ij, ki), (ij, j, jk), (ki, jk, k), (ij, jk, ki)]
        triangles = finer
    return vertices, triangles


def unit(v):
    length = math.hypot(*v)
    return tuple(x / length for x in v)


def faces_outwards(a, b, c):
    """Returns whether a triangle of a sphere around the origin faces outwards, by the sign of the triple product."""
    return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])) > 0


def write_vertices(file, vertices, centre, radius):
    for v in vertices:
        file.write("v %.7g %.7g %.7g\n" % tuple(c + radius * x for c, x in zip(centre, v)))


def write_faces(file, triangles, first):
    """Writes the faces of a sphere. `first`: number of its first vertex. All spheres share the normals, numbered from 1."""
    for i, j, k in triangles:
        file.write(f"f {first + i}//{i + 1} {first + j}//{j + 1} {first + k}//{k + 1}\n")


def write_normals(file, vertices):
    """Writes the vertices of the unit sphere as normals, for all spheres in the file."""
    for v in vertices:
        file.write("vn %.6f %.6f %.6f\n" % v)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output")
    parser.add_argument("--fineness", type=int, default=4, choices=range(10),
                        help="20 * 4**FINENESS triangles (default: 4, that is 5,120)")
    parser.add_argument("--radius", type=float, default=1.0)
    parser.add_argument("--centre", type=float, nargs=3, default=(0.0, 0.0, 0.0))
    parser.add_argument("--normals", action="store_true", help="write normals too, for a smooth look")
    options = parser.parse_args()

    vertices, triangles = icosphere(options.fineness)
    with open(options.output, "w", encoding="ascii") as file:
        file.write(f"# A closed sphere of {len(triangles)} triangles: make_sphere.py\no sphere\n")
        for v in vertices:
            # 17 digits keep the sphere's shape even if its centre is far away.
            file.write("v %.17g %.17g %.17g\n" % tuple(
                c + options.radius * x for c, x in zip(options.centre, v)))
        if options.normals:
            for v in vertices:
                file.write("vn %.9g %.9g %.9g\n" % v)
        for triangle in triangles:
            file.write("f " + " ".join(f"{i + 1}//{i + 1}" if options.normals else str(i + 1)
                                       for i in triangle) + "\n")


if __name__ == "__main__":
    making.run(main)
