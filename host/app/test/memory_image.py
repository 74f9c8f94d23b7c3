"""Reads a memory image of the ray core, as `render --dump-image FILE` writes it.

usage: memory_image.py FILE [--hex OUT]

Prints what is in it, and checks it: each line is reached once from the root, line 0; each box lies on its node's
grid; and it holds all corners of the triangles below it. --hex writes the lines for Verilog's $readmemh:
one a row, the highest digit first. Exit status 2 for a file that is no memory image.

The file is the memory, byte by byte: line n, of 64 bytes, is at byte 64 n. hw/ray_core/README.md has its fields.
"""

import argparse
import dataclasses
import fractions
import pathlib
import struct
import sys
import tempfile

LINE = 64
CHILDREN = 7
INNER = 8


class NoImage(Exception):
    """The file is none: where, what was found, what was expected."""


@dataclasses.dataclass
class Child:
    """A child of a node: its first line, how many lines (of a leaf: of triangles), its box."""

    line: int
    kind: int  # INNER, or the number of a leaf's triangles
    low: list[fractions.Fraction]
    high: list[fractions.Fraction]


def bits(line: int, first: int, width: int) -> int:
    """A field of a line, which is a number of 512 bits."""
    return line >> first & (1 << width) - 1


def number(line: int, word: int) -> fractions.Fraction:
    """A binary32 number, exactly."""
    value, = struct.unpack("<f", struct.pack("<I", bits(line, 32 * word, 32)))
    return fractions.Fraction(value)  # raises for infinities and NaN


def children(line: int) -> list[Child]:
    """The children of a node line."""
    at, found = bits(line, 120, 28), []
    cells = [fractions.Fraction(2) ** (bits(line, 96 + 8 * k, 8) - 127) for k in range(3)]
    for i in range(CHILDREN):
        kind = bits(line, 148 + 4 * i, 4)
        if kind == 0:
            continue
        low, high = ([number(line, k) + bits(line, first + 48 * i + 8 * k, 8) * cells[k] for k in range(3)]
                     for first in (176, 200))
        found.append(Child(at, kind, low, high))
        at += 1 if kind == INNER else kind
    return found


def triangle(line: int) -> tuple[list[list[fractions.Fraction]], int, int]:
    """The corners of a triangle line, its name, and its rank."""
    return [[number(line, 3 * i + k) for k in range(3)] for i in range(3)], bits(line, 288, 32), bits(line, 320, 32)


def check(lines: list[int]) -> dict[str, int]:
    """Nodes, triangles, depth; raises NoImage."""
    seen = [False] * len(lines)
    ranks: set[int] = set()
    counts = {"lines": len(lines), "nodes": 0, "triangles": 0, "depth": 0}

    def visit(place: int) -> int:
        if place >= len(lines) or seen[place]:
            raise NoImage(f"line {place}: found {'it twice' if place < len(lines) else 'none'}, expected it once")
        seen[place] = True
        return lines[place]

    def require_inside(corner: list[fractions.Fraction], boxes: list[Child], place: int) -> None:
        for box in boxes:
            if not all(a <= x <= b for a, x, b in zip(box.low, corner, box.high)):
                raise NoImage(f"line {place}: found a corner outside the box of line {box.line}, expected it inside")

    waiting: list[tuple[int, list[Child]]] = [(0, [])]
    while waiting:
        place, above = waiting.pop()
        counts["nodes"] += 1
        counts["depth"] = max(counts["depth"], len(above) + 1)
        for child in children(visit(place)):
            if child.kind == INNER:
                waiting.append((child.line, [*above, child]))
                continue
            if child.kind > CHILDREN:
                raise NoImage(f"line {place}: found a child of kind {child.kind}, expected 0 to {INNER}")
            for at in range(child.line, child.line + child.kind):
                corners, name, rank = triangle(visit(at))
                if name != at:
                    raise NoImage(f"line {at}: found a triangle named {name}, expected its line")
                if rank in ranks:
                    raise NoImage(f"line {at}: found rank {rank} again, expected it once")
                ranks.add(rank)
                counts["triangles"] += 1
                for corner in corners:
                    require_inside(corner, [*above, child], at)
    if not all(seen):
        raise NoImage(f"line {seen.index(False)}: found no way there, expected one from the root")
    return counts


def read(file: pathlib.Path) -> list[int]:
    """The lines of a file, each a number of 512 bits."""
    data = file.read_bytes()
    if not data or len(data) % LINE:
        raise NoImage(f"found {len(data)} bytes, expected some lines of {LINE}")
    return [int.from_bytes(data[at:at + LINE], "little") for at in range(0, len(data), LINE)]


def main() -> int:
    """Runs the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("--hex", type=pathlib.Path, help="write the lines for $readmemh")
    given = parser.parse_args()
    try:
        lines = read(given.file)
        counts = check(lines)
        if given.hex:
            with tempfile.TemporaryDirectory(dir=given.hex.resolve().parent) as folder:
                whole = pathlib.Path(folder, "hex")
                whole.write_text("".join(f"{line:0{2 * LINE}x}\n" for line in lines))
                whole.replace(given.hex.resolve())
    except OSError as error:
        print(f"{error.filename}: {error.strerror}", file=sys.stderr)
        return 2
    except (NoImage, OverflowError, ValueError) as error:
        print(f"{given.file}: {error}", file=sys.stderr)
        return 2
    print(", ".join(f"{count:,} {name}" for name, count in counts.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
