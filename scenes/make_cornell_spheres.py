#!/usr/bin/env python3
"""Writes the Cornell box with a mirror and a glass sphere in place of its blocks, as OBJ and MTL."""
import argparse
import pathlib

import making
from make_sphere import icosphere, write_faces, write_normals, write_vertices

MATERIALS = """
newmtl mirror
Kd 0 0 0
Ks 0.95 0.95 0.95
Ns 1000
illum 3

newmtl glass
Kd 0 0 0
Ks 0.1 0.1 0.1
Tf 1 1 1
Ni 1.5
Ns 1000
d 0.05
illum 7
"""

# Name, material, centre and radius, in millimetres. The spheres are slightly above the floor.
SPHERES = [("mirror_sphere", "mirror", (380, 90.01, 180), 90),
           ("glass_sphere", "glass", (176, 90.01, 370), 90)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", type=pathlib.Path, help="the OBJ file; the MTL file goes beside it")
    parser.add_argument("--fineness", type=int, default=4, choices=range(8),
                        help="20 * 4**FINENESS triangles a sphere (default: 4)")
    options = parser.parse_args()

    here = pathlib.Path(__file__).parent
    materials = options.output.with_suffix(".mtl")
    materials.write_text((here / "cornell.mtl").read_text(encoding="ascii") + MATERIALS,
                         encoding="ascii")
    room, blocks, _ = (here / "cornell.obj").read_text(encoding="ascii").partition("o short_block")
    assert blocks
    vertices, triangles = icosphere(options.fineness)
    with open(options.output, "w", encoding="ascii") as file:
        file.write(room.replace("cornell.mtl", materials.name))
        write_normals(file, vertices)
        first = sum(line.startswith("v ") for line in room.splitlines()) + 1
        for name, material, centre, radius in SPHERES:
            file.write(f"o {name}\nusemtl {material}\n")
            write_vertices(file, vertices, centre, radius)
            write_faces(file, triangles, first)
            first += len(vertices)


if __name__ == "__main__":
    making.run(main)
