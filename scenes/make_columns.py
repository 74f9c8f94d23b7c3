#!/usr/bin/env python3
"""Writes a ring of square columns under a low light as OBJ and MTL: long shadows, no curved surface.
"""
import argparse
import math
import pathlib

import making

MATERIALS = """\
newmtl floor
Kd 0.7 0.66 0.6
illum 1

newmtl column
Kd 0.75 0.72 0.68
illum 1

newmtl cap
Kd 0.7 0.25 0.12
illum 1
"""


def write_block(file, first, centre, turned, half, low, high):
    """Writes an upright block on a square of side 2 `half`. `first`: number of its first vertex. Returns the number after its last."""
    for y in (low, high):
        for corner in range(4):
            angle = turned + math.pi / 4 + corner * math.pi / 2
            file.write("v %.6g %.6g %.6g\n" % (centre[0] + half * math.sqrt(2) * math.cos(angle), y,
                                               centre[1] - half * math.sqrt(2) * math.sin(angle)))
    a, b, c, d, e, f, g, h = range(first, first + 8)
    for face in ((e, f, g, h), (d, c, b, a), (a, b, f, e), (b, c, g, f), (c, d, h, g), (d, a, e, h)):
        file.write("f %d %d %d %d\n" % face)
    return first + 8


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", type=pathlib.Path, help="the OBJ file; the MTL file goes beside it")
    parser.add_argument("--columns", type=making.at_least(1), default=12)
    options = parser.parse_args()

    materials = options.output.with_suffix(".mtl")
    materials.write_text(MATERIALS, encoding="ascii")
    with open(options.output, "w", encoding="ascii") as file:
        file.write(f"# A ring of columns: make_columns.py\nmtllib {materials.name}\no floor\n"
                   "v -12 0 12\nv 12 0 12\nv 12 0 -12\nv -12 0 -12\nusemtl floor\nf 1 2 3 4\n")
        first = 5
        for i in range(options.columns):
            angle = 2 * math.pi * i / options.columns
            centre = (4 * math.cos(angle), -4 * math.sin(angle))
            file.write(f"o column{i + 1}\nusemtl column\n")
            first = write_block(file, first, centre, angle, 0.3, 0.001, 2.2)
            file.write("usemtl cap\n")
            first = write_block(file, first, centre, angle, 0.42, 2.201, 2.5)


if __name__ == "__main__":
    making.run(main)
