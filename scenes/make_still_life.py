#!/usr/bin/env python3
"""Writes a still life as OBJ, MTL and PNG: a globe, a glass and a mirror sphere on a tiled floor.

The script also draws the textures: tiles for the floor, and a map of invented continents for the globe.
"""
import argparse
import math
import pathlib
import struct
import zlib

import making
from make_sphere import icosphere, unit, write_faces, write_normals, write_vertices

MATERIALS = """\
newmtl floor
Kd 0.9 0.9 0.9
map_Kd -s 12 12 tiles.png
Ks 0.04 0.04 0.04
Ns 200
illum 3

newmtl globe
map_Kd globe.png
Ks 0.05 0.05 0.05
Ns 80
illum 2

newmtl glass
Kd 0 0 0
Ks 0.1 0.1 0.1
Tf 0.97 1 0.98
Ni 1.5
Ns 1000
d 0.05
illum 7

newmtl mirror
Kd 0.02 0.02 0.02
Ks 0.9 0.82 0.6
Ns 1000
illum 3
"""


def write_png(path, width, height, color_at):
    """Writes a PNG file with 24-bit RGB. color_at(x, y) returns three codes from 0 to 255."""
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))
    rows = b"".join(b"\0" + bytes(code for x in range(width) for code in color_at(x, y))
                    for y in range(height))
    path.write_bytes(b"\x89PNG\r\n\x1a\n"
                     + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def tile_at(x, y):
    """Returns the colour of a texture of four tiles, dark and light, with joints."""
    if x % 32 == 0 or y % 32 == 0:
        return 70, 66, 60
    return (196, 186, 168) if (x // 32 + y // 32) % 2 else (98, 84, 76)


def globe_at(x, y):
    """Returns the colour of the globe's map: land where a sum of waves is high, a grid of degrees, white poles."""
    longitude, latitude = 2 * math.pi * (x + 0.5) / 512, math.pi * (0.5 - (y + 0.5) / 256)
    if abs(latitude) > 1.25:
        return 235, 240, 245
    if x % 32 == 0 or (y - 128) % 32 == 0:
        return 40, 60, 90
    height = (math.sin(2 * longitude + 1.3 * math.sin(3 * latitude))
              + math.cos(3 * longitude - 2 * latitude + 1) * math.cos(2 * latitude)
              + 0.5 * math.sin(7 * longitude + 5 * latitude))
    if height > 0.5:
        return (180, 160, 90) if height > 1.4 else (90, 140, 70)
    return 50, 105, 165


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", type=pathlib.Path,
                        help="the OBJ file; its MTL and PNG files go beside it")
    options = parser.parse_args()

    folder = options.output.parent
    materials = options.output.with_suffix(".mtl")
    materials.write_text(MATERIALS, encoding="ascii")
    write_png(folder / "tiles.png", 64, 64, tile_at)
    write_png(folder / "globe.png", 512, 256, globe_at)

    vertices, triangles = icosphere(4)
    with open(options.output, "w", encoding="ascii") as file:
        file.write(f"# A still life: make_still_life.py\nmtllib {materials.name}\no floor\n")
        file.write("v -6 0 6\nv 6 0 6\nv 6 0 -6\nv -6 0 -6\n"
                   "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl floor\nf 1/1 2/2 3/3 4/4\n")
        write_normals(file, vertices)
        first, first_uv = 5, 5
        for name, centre, radius in (("globe", (-1.15, 1.0, -0.6), 1.0),
                                     ("glass", (0.75, 0.8, 0.7), 0.8),
                                     ("mirror", (1.9, 0.9, -1.5), 0.9)):
            file.write(f"o {name}\nusemtl {name}\n")
            write_vertices(file, vertices, centre, radius * 1.0001)
            if name == "globe":
                first_uv = write_globe(file, vertices, triangles, first, first_uv)
            else:
                write_faces(file, triangles, first)
            first += len(vertices)


def write_globe(file, vertices, triangles, first, first_uv):
    """Writes faces with longitude and latitude as texture coordinates. Each face has coordinates of its own, because of the seam where
    longitudes wrap around. Returns the number of the next texture coordinates."""
    axis = unit((0.3, 1.0, 0.1))
    east = unit((axis[1], -axis[0], 0.0))
    north = (axis[1] * east[2] - axis[2] * east[1], axis[2] * east[0] - axis[0] * east[2],
             axis[0] * east[1] - axis[1] * east[0])

    def dot(a, b):
        return sum(p * q for p, q in zip(a, b))

    def uv(v):
        return (math.atan2(dot(v, north), dot(v, east)) / (2 * math.pi) + 0.5,
                0.5 + math.asin(max(-1.0, min(1.0, dot(v, axis)))) / math.pi)

    for triangle in triangles:
        corners = [uv(vertices[i]) for i in triangle]
        if max(u for u, _ in corners) - min(u for u, _ in corners) > 0.5:
            corners = [(u + 1 if u < 0.5 else u, v) for u, v in corners]
        for u, v in corners:
            file.write("vt %.6f %.6f\n" % (u, v))
        file.write("f " + " ".join(f"{first + i}/{first_uv + n}/{i + 1}"
                                   for n, i in enumerate(triangle)) + "\n")
        first_uv += 3
    return first_uv


if __name__ == "__main__":
    making.run(main)
