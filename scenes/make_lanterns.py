#!/usr/bin/env python3
"""Writes a courtyard at night under strings of small lanterns as OBJ and MTL: a thousand lights."""
import argparse
import math
import pathlib

import making
from make_columns import write_block
from make_sphere import icosphere, write_faces, write_normals, write_vertices

MATERIALS = """\
newmtl stone
Kd 0.62 0.58 0.52
illum 1

newmtl column
Kd 0.7 0.66 0.62
illum 1

newmtl clay
Kd 0.68 0.36 0.22
illum 1
"""
COLOURS = ("3 2.2 1.2", "3 1 0.5", "1 2.2 1.1", "0.8 1.4 3")
HALF = 10.0  # half the length of the courtyard's side
RADIUS = 0.07  # radius of a lantern


def write_lantern(file, first, centre, colour):
    """Writes an octahedron. `first`: number of its first vertex. Returns the number after its last vertex."""
    file.write(f"o lantern{first}\nusemtl lantern{colour}\n")
    for axis in range(3):
        for sign in (1, -1):
            v = list(centre)
            v[axis] += sign * RADIUS * (1.4 if axis == 1 else 1)
            file.write("v %.6g %.6g %.6g\n" % tuple(v))
    a, b, c, d, e, f = range(first, first + 6)
    for face in ((a, c, e), (e, c, b), (b, c, f), (f, c, a), (e, d, a), (b, d, e), (f, d, b), (a, d, f)):
        file.write("f %d %d %d\n" % face)
    return first + 6


def places(strings, lanterns):
    """Yields (number of the string, centre) of each lantern. Strings sag between opposite walls, alternately along x and along z."""
    for string in range(strings):
        aside = HALF * (2 * (string + 0.5) / strings - 1)
        for i in range(lanterns):
            along = 2 * (i + 0.5) / lanterns - 1
            height = 2.3 + 0.9 * along ** 2 + (0.5 if string % 2 else 0)
            place = (aside, height, 0.97 * HALF * along)
            yield string, place if string % 2 else place[::-1]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=pathlib.Path, help="the OBJ file; the MTL file goes beside it")
    parser.add_argument("--strings", type=making.at_least(1), default=24)
    parser.add_argument("--lanterns", type=making.at_least(1), default=42, help="of each string")
    options = parser.parse_args()

    materials = options.output.with_suffix(".mtl")
    materials.write_text(MATERIALS + "".join(
        f"\nnewmtl lantern{i}\nKd 0 0 0\nKe {colour}\nillum 1\n" for i, colour in enumerate(COLOURS)),
        encoding="ascii")
    vertices, triangles = icosphere(3)
    with open(options.output, "w", encoding="ascii") as file:
        file.write(f"# make_lanterns.py\nmtllib {materials.name}\n")
        write_normals(file, vertices)
        file.write("o court\nusemtl stone\n")
        for x, z in ((-HALF, HALF), (HALF, HALF), (HALF, -HALF), (-HALF, -HALF)):
            file.write(f"v {x:g} 0 {z:g}\nv {x:g} 4 {z:g}\n")
        file.write("f 1 3 5 7\nf 5 6 8 7\nf 3 4 6 5\nf 7 8 2 1\n")
        first = 9
        for i in range(8):
            angle = 2 * math.pi * (i + 0.5) / 8
            file.write(f"o column{i}\nusemtl column\n")
            first = write_block(file, first, (6 * math.cos(angle), -6 * math.sin(angle)), angle, 0.4,
                                0.001, 2.2)
        for i, (x, z, radius) in enumerate(((-2, 1, 1), (1.6, 2.4, 0.7), (0.6, -1.6, 1.3),
                                            (3.4, -0.6, 0.5), (-3.6, -2.2, 0.6))):
            file.write(f"o ball{i}\nusemtl clay\n")
            write_vertices(file, vertices, (x, radius + 0.001, z), radius)
            write_faces(file, triangles, first)
            first += len(vertices)
        for string, place in places(options.strings, options.lanterns):
            first = write_lantern(file, first, place, string % len(COLOURS))


if __name__ == "__main__":
    making.run(main)
