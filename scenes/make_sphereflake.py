#!/usr/bin/env python3
"""Writes a sphereflake as OBJ and MTL: a sphere that carries nine of a third its size, and so on.

After Eric Haines, "A Proposal for Standard Graphics Environments", 1987. The default depth gives 820 spheres of 320 triangles
above a floor of 2: 262,402 triangles.
"""
import argparse
import math
import pathlib

import making
from make_sphere import icosphere, unit, write_faces, write_normals, write_vertices

MATERIALS = """\
newmtl floor
Kd 0.5 0.47 0.42
illum 1

newmtl sphere0
Kd 0.08 0.08 0.1
Ks 0.8 0.8 0.8
Ns 500
illum 3

newmtl sphere1
Kd 0.6 0.25 0.08
Ks 0.2 0.2 0.2
Ns 100
illum 3

newmtl sphere2
Kd 0.1 0.35 0.55
Ks 0.1 0.1 0.1
Ns 60
illum 2

newmtl sphere3
Kd 0.75 0.72 0.6
illum 1
"""


def spheres_of(centre, radius, axis, depth, generation=0):
    """Yields (centre, radius, generation) of a sphere and of all spheres attached to it, directly or indirectly."""
    yield centre, radius, generation
    if generation == depth:
        return
    # u and v: two unit vectors perpendicular to the axis.
    across = min(range(3), key=lambda i: abs(axis[i]))
    u = unit(cross(axis, tuple(float(i == across) for i in range(3))))
    v = cross(axis, u)
    # Six spheres around the equator, and three above, raised so that they are at the angle between a cube's edges and its diagonal.
    places = [(0.0, (k + 0.25) / 6) for k in range(6)]
    places += [(math.asin(math.sqrt(2 / 3)), (k + 0.375) / 3) for k in range(3)]
    for raised, turned in places:
        turned *= 2 * math.pi
        direction = tuple(math.sin(raised) * axis[i] + math.cos(raised) *
                          (math.cos(turned) * u[i] + math.sin(turned) * v[i]) for i in range(3))
        child = tuple(centre[i] + direction[i] * radius * 4 / 3 for i in range(3))
        yield from spheres_of(child, radius / 3, direction, depth, generation + 1)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", type=pathlib.Path, help="the OBJ file; the MTL file goes beside it")
    parser.add_argument("--depth", type=int, default=3, choices=range(4),
                        help="generations of children (default: 3)")
    parser.add_argument("--fineness", type=int, default=2, choices=range(7),
                        help="20 * 4**FINENESS triangles a sphere (default: 2)")
    options = parser.parse_args()

    materials = options.output.with_suffix(".mtl")
    materials.write_text(MATERIALS, encoding="ascii")
    vertices, triangles = icosphere(options.fineness)
    with open(options.output, "w", encoding="ascii") as file:
        file.write(f"# A sphereflake: make_sphereflake.py\nmtllib {materials.name}\n")
        write_normals(file, vertices)
        file.write("o floor\nv -3 -2 3\nv 3 -2 3\nv 3 -2 -3\nv -3 -2 -3\n"
                   "usemtl floor\nf 1 2 3 4\n")
        first = 5
        axis = unit((0.15, 1.0, 0.25))
        for centre, radius, generation in spheres_of((0.0, 0.0, 0.0), 1.0, axis, options.depth):
            file.write(f"o sphere{first}\nusemtl sphere{generation}\n")
            write_vertices(file, vertices, centre, radius)
            write_faces(file, triangles, first)
            first += len(vertices)


if __name__ == "__main__":
    making.run(main)
