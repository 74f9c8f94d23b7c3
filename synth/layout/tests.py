"""A thousand tests of equation 10 as operands for simulation: what the units' cores are given.

Rays from one origin over a scene, each against one of its triangles in turn, in binary32 to nearest:
N = (B - A) x (C - A), d = N.A, I scaled so that its largest component is in [1, 2); I.N by three
multiplications and two additions, t = d / I.N, and P = t I by three more multiplications.
"""

import pathlib

import numpy as np

from synth import tools
from synth.catalogue import Design

SCENE = tools.ROOT / "scenes" / "teapot.obj"
COUNT = 1000
# The cores whose operands the tests have: how many operations are simulated (a divider toggles the most),
# and the width that the operands are of.
TOPS = {"adder": (COUNT, 48), "booth_multiplier": (COUNT, 24), "multiplier": (COUNT, 24),
        "fp_multiplier": (COUNT, None), "fp_adder": (COUNT, None), "fp_divider": (COUNT // 5, None)}
# Operations of a float core in a test of equation 10.
OPERATIONS = {"fp_multiplier": 6, "fp_adder": 2, "fp_divider": 1}


def triangles(file: pathlib.Path) -> np.ndarray:
    """The corners of an OBJ file's triangles, polygons as fans: [triangle, corner, axis]."""
    corners, found = [], []
    for line in file.read_text().splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            corners.append([float(value) for value in rest[:3]])
        elif word == "f":
            names = [int(name.split("/")[0]) for name in rest]
            points = [corners[name - 1 if name > 0 else name] for name in names]
            found += [[points[0], one, other] for one, other in zip(points[1:], points[2:])]
    return np.array(found, np.float32)


def eye(scene: np.ndarray) -> np.ndarray:
    """The rays' origin: before the middle of the scene's box."""
    low, high = scene.min(axis=(0, 1)), scene.max(axis=(0, 1))
    return np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, high[2] + (high[2] - low[2])], np.float32)


def towards(origin: np.ndarray, point: np.ndarray) -> np.ndarray:
    """The direction, its largest component in [1, 2)."""
    i = (point - origin).astype(np.float32)
    return np.ldexp(i, 1 - np.frexp(np.abs(i).max())[1]).astype(np.float32)


def operands(file: pathlib.Path = SCENE, count: int = COUNT) -> dict[str, list[tuple[np.float32, np.float32]]]:
    """The operand pairs of each core, in the order of the tests: "multiply", "add", "divide"."""
    scene = triangles(file)
    low, high = scene.min(axis=(0, 1)), scene.max(axis=(0, 1))
    origin = eye(scene)
    side = int(np.ceil(count ** 0.5))
    found: dict[str, list] = {"multiply": [], "add": [], "divide": []}
    for test in range(count):
        aim = np.array([low[0] + (high[0] - low[0]) * (test % side + 0.5) / side,
                        low[1] + (high[1] - low[1]) * (test // side + 0.5) / side, (low[2] + high[2]) / 2])
        i = towards(origin, aim)
        a, b, c = scene[test * 7 % len(scene)] - origin
        n = np.cross(b - a, c - a).astype(np.float32)
        d = np.float32(np.dot(n, a))
        products = [multiply(found, x, y) for x, y in zip(i, n)]
        within = add(found, add(found, products[0], products[1]), products[2])
        if within == 0:
            continue
        found["divide"].append((d, within))
        t = np.float32(d / within)
        for x in i:
            multiply(found, x, t)
    return found


def multiply(found: dict[str, list], x: np.float32, y: np.float32) -> np.float32:
    """x y, noted down."""
    found["multiply"].append((x, y))
    return np.float32(x * y)


def add(found: dict[str, list], x: np.float32, y: np.float32) -> np.float32:
    """x + y, noted down."""
    found["add"].append((x, y))
    return np.float32(x + y)


def significand(value: np.float32) -> int:
    """Its 24 bits, the leading one among them."""
    bits = int(np.float32(value).view(np.uint32))
    return bits & 0x7FFFFF | (0x800000 if bits >> 23 & 255 else 0)


def fit(design: Design) -> bool:
    """Whether the tests have operands for this design: of float cores whose exponents have 8 bits."""
    parameters = dict(design.parameters)
    width = int(parameters.get("Width", 0)) or None
    return (design.top in TOPS and not design.tied and TOPS[design.top][1] == width
            and parameters.get("ExpWidth", "8") == "8" and "QuotientBits" not in parameters)


def words(design: Design, file: pathlib.Path = SCENE) -> list[dict[str, int]]:
    """What the inputs of a core are in each of its operations; the others are 0, which is to nearest.

    A float core of fewer bits is given the same operands, cut off; an adder of 48 bits the multiplier's
    exact products, two in a row. ValueError for a design that does not `fit`.
    """
    if not fit(design):
        raise ValueError(f"no tests for {design.name}, expected one of {', '.join(TOPS)}, of binary32's width")
    count = TOPS[design.top][0]
    found = operands(file, count)
    if design.top in OPERATIONS:
        kind = {"fp_multiplier": "multiply", "fp_adder": "add", "fp_divider": "divide"}[design.top]
        drop = 23 - int(dict(design.parameters).get("FracWidth", 23))
        pairs = [tuple(int(np.float32(value).view(np.uint32)) >> drop for value in pair)
                 for pair in found[kind]]
    else:
        pairs = [tuple(map(significand, pair)) for pair in found["multiply"]]
        if design.top == "adder":
            products = [a * b for a, b in pairs]
            pairs = list(zip(products, products[1:]))
    return [{"a_i": a, "b_i": b} for a, b in pairs[:count]]
