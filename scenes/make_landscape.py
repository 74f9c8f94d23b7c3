#!/usr/bin/env python3
"""Writes a landscape as OBJ and MTL: a square of hills, two triangles to each cell of a grid.

Heights are sums of octaves of value noise: random numbers at the corners of a lattice, interpolated
smoothly. Each octave has half the wavelength and half the height of the octave before. The default
of 448 cells per side makes 401,408 triangles.
"""
import argparse
import pathlib
import random

import making

MATERIAL = """\
newmtl ground
Kd 0.45 0.4 0.3
illum 1
"""


def smooth(t):
    return t * t * (3 - 2 * t)


def octave(cells, waves, rng):
    """Yields rows of heights at the (cells + 1)^2 corners of the grid, interpolated from random heights on `waves` x `waves` cells."""
    lattice = [[rng.uniform(-1, 1) for _ in range(waves + 2)] for _ in range(waves + 2)]
    steps = [divmod(i * waves, cells) for i in range(cells + 1)]
    steps = [(whole, smooth(part / cells)) for whole, part in steps]
    for j, y in steps:
        low, high = lattice[j], lattice[j + 1]
        row = [a + y * (b - a) for a, b in zip(low, high)]
        yield [row[i] + x * (row[i + 1] - row[i]) for i, x in steps]


def landscape(cells, seed):
    """Returns rows of heights at the (cells + 1)^2 corners of a grid of side 1: the sum of all octaves."""
    rng = random.Random(seed)
    heights = [[0.0] * (cells + 1) for _ in range(cells + 1)]
    waves, height = 4, 0.08
    while waves <= cells:
        for row, added in zip(heights, octave(cells, waves, rng)):
            row[:] = [h + height * a for h, a in zip(row, added)]
        waves, height = 2 * waves, height / 2
    return heights


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--cells", type=making.at_least(1), default=448, help="along each side (default: 448)")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()

    cells = options.cells
    material = options.output.with_suffix(".mtl")
    material.write_text(MATERIAL, encoding="ascii")
    with open(options.output, "w", encoding="ascii") as file:
        file.write(f"# Hills of {2 * cells * cells} triangles: make_landscape.py\n"
                   f"mtllib {material.name}\no landscape\nusemtl ground\n")
        for j, row in enumerate(landscape(cells, options.seed)):
            for i, height in enumerate(row):
                file.write(f"v {i / cells - 0.5:.9g} {height:.9g} {j / cells - 0.5:.9g}\n")
        for j in range(cells):
            for i in range(cells):
                a = j * (cells + 1) + i + 1
                b = a + cells + 1
                file.write(f"f {a} {b} {b + 1}\nf {a} {b + 1} {a + 1}\n")


if __name__ == "__main__":
    making.run(main)
