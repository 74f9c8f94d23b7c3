#!/usr/bin/env python3
"""Writes Newell's teapot as OBJ, with normals: 32 bicubic Bezier patches cut into triangles.

Source: M. Newell, "The Utilization of Procedure Models in Digital Image Synthesis", University of
Utah, 1975; control points as in F. Crow, "The Origins of the Teapot", IEEE CG&A 7(1), 1987, with
the bottom that was added later. y is up, the spout points along +x. The surface is the original's:
the lid does not quite touch the rim, and handle and spout pass through the wall.
"""
import argparse
import math

import making

# The round parts: rings of four patches, each with four rows of (radius r, height). The control points
# of a row in a quadrant are (r, 0), (r, q), (q, r), (0, r), with q = 0.56 r, or the row's third number:
# Newell's knob has 0.45 instead of 0.448.
ROUND_PARTS = {
    "rim": [(1.4, 2.4), (1.3375, 2.53125), (1.4375, 2.53125), (1.5, 2.4)],
    "body": [(1.5, 2.4), (1.75, 1.875), (2.0, 1.35), (2.0, 0.9)],
    "lower_body": [(2.0, 0.9), (2.0, 0.45), (1.5, 0.225), (1.5, 0.15)],
    "knob": [(0.0, 3.15), (0.8, 3.15, 0.45), (0.0, 2.85), (0.2, 2.7)],
    "lid": [(0.2, 2.7), (0.4, 2.55), (1.3, 2.55), (1.3, 2.4)],
    "bottom": [(1.5, 0.15), (1.5, 0.075), (1.425, 0.0), (0.0, 0.0)],
}

# Handle and spout: rows of (inner x, height, outer x, height, half width). Each patch is half of a
# tube; the other half is its mirror image.
TUBES = {
    "handle": [(-1.6, 2.025, -1.5, 2.25, 0.3), (-2.3, 2.025, -2.5, 2.25, 0.3),
               (-2.7, 2.025, -3.0, 2.25, 0.3), (-2.7, 1.8, -3.0, 1.8, 0.3)],
    "lower_handle": [(-2.7, 1.8, -3.0, 1.8, 0.3), (-2.7, 1.575, -3.0, 1.35, 0.3),
                     (-2.5, 1.125, -2.65, 0.9375, 0.3), (-2.0, 0.9, -1.9, 0.6, 0.3)],
    "spout": [(1.7, 1.425, 1.7, 0.6, 0.66), (2.6, 1.425, 3.1, 0.825, 0.66),
              (2.3, 2.1, 2.4, 2.025, 0.25), (2.7, 2.4, 3.3, 2.4, 0.25)],
    "spout_lip": [(2.7, 2.4, 3.3, 2.4, 0.25), (2.8, 2.475, 3.525, 2.49375, 0.25),
                  (2.9, 2.475, 3.45, 2.5125, 0.15), (2.8, 2.4, 3.2, 2.4, 0.15)],
}


def patches():
    """Yields (name, 4 x 4 control points) of each patch. Parameter u runs along the rows, v across the rows."""
    for name, rows in ROUND_PARTS.items():
        for sine, cosine in ((0, 1), (1, 0), (0, -1), (-1, 0)):  # the four quadrants
            patch = []
            for radius, height, *quarter in rows:
                q = quarter[0] if quarter else 0.56 * radius
                patch.append([(x * cosine + z * sine, height, z * cosine - x * sine)
                              for x, z in ((radius, 0), (radius, q), (q, radius), (0, radius))])
            yield name, patch
    for name, rows in TUBES.items():
        for side in (1, -1):
            patch = [[(xi, yi, 0), (xi, yi, side * w), (xo, yo, side * w), (xo, yo, 0)]
                     for xi, yi, xo, yo, w in rows]
            yield name, patch


def bezier(points, t):
    """Returns the value and the derivative of a cubic Bezier curve at t."""
    s = 1 - t
    weights = (s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t)
    slopes = (-3 * s * s, 3 * s * (s - 2 * t), 3 * t * (2 * s - t), 3 * t * t)
    return tuple(tuple(sum(w * p[i] for w, p in zip(ws, points)) for i in range(3))
                 for ws in (weights, slopes))


def surface(patch, u, v):
    """Returns the point at (u, v), and the cross product of the partial derivatives (the normal, unscaled)."""
    along = [bezier(column, u) for column in zip(*patch)]
    point, dv = bezier([value for value, _ in along], v)
    du, _ = bezier([slope for _, slope in along], v)
    return point, cross(du, dv)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def normal_at(patch, u, v):
    """Returns the unit normal. At a pole, where one border of the patch shrinks to a point, returns the normal of a nearby point."""
    _, normal = surface(patch, u, v)
    if math.hypot(*normal) < 1e-9:
        _, normal = surface(patch, u + 1e-4 * (0.5 - u), 0.5)
        normal = (0.0, normal[1], 0.0)  # poles lie on the axis
    length = math.hypot(*normal)
    return tuple(x / length for x in normal)


def outward_sign(patch):
    """Returns 1 or -1: the factor that turns the cross product of `surface` away from the pot's middle, or from the tube's axis."""
    middle, normal = surface(patch, 0.5, 0.5)
    corners = [p for row in patch for p in row]
    if all(abs(p[2]) < 1 for p in corners):  # a tube: outwards is away from the tube's axis
        return math.copysign(1, normal[2] * middle[2])
    return math.copysign(1, dot(normal, (middle[0], middle[1] - 1.2, middle[2])))


class Writer:
    """Writes each distinct vertex or normal once, and numbers them."""

    def __init__(self, file):
        self.file = file
        self.numbers = {"v": {}, "vn": {}}

    def number(self, keyword, xyz):
        # + 0.0: no negative zero
        line = keyword + " " + " ".join("%.6g" % (round(x, 6) + 0.0) for x in xyz)
        numbers = self.numbers[keyword]
        if line not in numbers:
            numbers[line] = len(numbers) + 1
            self.file.write(line + "\n")
        return numbers[line]


def write_patch(writer, patch, fineness):
    sign = outward_sign(patch)
    corner = {}
    for i in range(fineness + 1):
        for j in range(fineness + 1):
            u, v = i / fineness, j / fineness
            point, _ = surface(patch, u, v)
            normal = tuple(sign * x for x in normal_at(patch, u, v))
            corner[i, j] = (writer.number("v", point), writer.number("vn", normal))
    for i in range(fineness):
        for j in range(fineness):
            a, b, c, d = (corner[i, j], corner[i + 1, j], corner[i + 1, j + 1], corner[i, j + 1])
            for triangle in ((a, b, c), (a, c, d)):
                if len({vertex for vertex, _ in triangle}) < 3:
                    continue  # at a pole
                if sign < 0:
                    triangle = triangle[::-1]
                writer.file.write("f " + " ".join("%d//%d" % c for c in triangle) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("output")
    parser.add_argument("--fineness", type=int, default=8, choices=range(1, 101), metavar="N",
                        help="each patch becomes N x N x 2 triangles (default: 8)")
    options = parser.parse_args()
    with open(options.output, "w", encoding="ascii", newline="\n") as file:
        file.write("# Newell's teapot: make_teapot.py --fineness %d\nmtllib teapot.mtl\n"
                   "usemtl porcelain\n" % options.fineness)
        writer = Writer(file)
        part = None
        for name, patch in patches():
            if name != part:
                part = name
                file.write("g %s\n" % name)
            write_patch(writer, patch, options.fineness)


if __name__ == "__main__":
    making.run(main)
