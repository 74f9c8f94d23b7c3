#!/usr/bin/env python3
"""Writes spheres of metal, plastic and glass from smooth to rough as OBJ and MTL, and an evening sky
as a Radiance HDR picture beside them."""
import argparse
import math
import pathlib

import making
from make_sphere import icosphere, unit, write_faces, write_normals, write_vertices

COLUMNS = 5
KINDS = {  # Kd, Pm, further MTL statements
    "metal": ("0.95 0.64 0.34", 1.0, ""),
    "plastic": ("0.12 0.35 0.6", 0.0, ""),
    "glass": ("0.93 0.98 0.95", 0.0, "Ni 1.5\nillum 7\n"),
}
WIDTH, HEIGHT = 256, 128
SUN = unit((-0.75, 0.34, -0.55))


def roughness(column):
    return 0.03 + 0.57 * column / (COLUMNS - 1)


def write_scene(output):
    vertices, triangles = icosphere(4)
    with open(output.with_suffix(".mtl"), "w", encoding="ascii") as file:
        file.write("newmtl floor\nKd 0.42 0.4 0.38\nillum 1\n")
        for kind, (colour, metallic, more) in KINDS.items():
            for column in range(COLUMNS):
                file.write(f"\nnewmtl {kind}{column}\nKd {colour}\nPm {metallic:g}\n"
                           f"Pr {roughness(column):g}\n{more}")
    with open(output, "w", encoding="ascii") as file:
        file.write(f"# make_rough_spheres.py\nmtllib {output.with_suffix('.mtl').name}\n")
        write_normals(file, vertices)
        file.write("o floor\nusemtl floor\nv -40 0 -40\nv -40 0 40\nv 40 0 40\nv 40 0 -40\n"
                   "f 1 2 3 4\n")
        first = 5
        for row, kind in enumerate(KINDS):
            for column in range(COLUMNS):
                file.write(f"o {kind}{column}\nusemtl {kind}{column}\n")
                centre = (2.3 * (column - (COLUMNS - 1) / 2), 1.0, 2.4 * (row - 1))
                write_vertices(file, vertices, centre, 1.0)
                write_faces(file, triangles, first)
                first += len(vertices)


def sky(direction):
    """Returns the radiance from a direction: glow of a low sun, sky with a warm horizon, dark ground."""
    _, height, _ = direction
    if height < 0:
        return (0.1, 0.09, 0.08)
    low = (1 - height) ** 4
    light = [a + (b - a) * low for a, b in zip((0.1, 0.2, 0.45), (0.85, 0.6, 0.4))]
    towards = max(0.0, sum(a * b for a, b in zip(direction, SUN)))
    glow = 14 * towards ** 60
    return tuple(x + glow * tint for x, tint in zip(light, (1.0, 0.75, 0.5)))


def rgbe(colour):
    """Encodes a colour in four bytes: three mantissas and a common exponent (Ward, 1991)."""
    exponent = math.frexp(max(colour))[1]
    scale = math.ldexp(256.0, -exponent)
    return bytes([min(255, int(x * scale)) for x in colour] + [exponent + 128])


def write_sky(output):
    with open(output, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (HEIGHT, WIDTH))
        for y in range(HEIGHT):
            angle = math.pi * (y + 0.5) / HEIGHT
            for x in range(WIDTH):
                turn = 2 * math.pi * ((x + 0.5) / WIDTH - 0.5)
                file.write(rgbe(sky((math.sin(angle) * math.sin(turn), math.cos(angle),
                                     -math.sin(angle) * math.cos(turn)))))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=pathlib.Path)
    output = parser.parse_args().output
    write_scene(output)
    write_sky(output.with_name(output.stem + "_sky.hdr"))


if __name__ == "__main__":
    making.run(main)
