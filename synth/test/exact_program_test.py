"""The micro-programs of hw/exact take the signs of the polynomials that host/exact defines."""

import collections
import copy
import itertools
import re
import unittest

from synth import exact_program
from synth.exact_program import FLOATS, KINDS, NUMBERS, Instruction


def variable(name: str) -> dict:
    """A polynomial: coefficients by sorted tuple of variables."""
    return {(name,): 1}


def plus(x: dict, y: dict, factor: int = 1) -> dict:
    """x + factor y."""
    total = collections.Counter(x)
    for monomial, coefficient in y.items():
        total[monomial] += factor * coefficient
    return {monomial: coefficient for monomial, coefficient in total.items() if coefficient}


def times(x: dict, y: dict) -> dict:
    """x y."""
    total = collections.Counter()
    for (one, a), (other, b) in itertools.product(x.items(), y.items()):
        total[tuple(sorted(one + other))] += a * b
    return {monomial: coefficient for monomial, coefficient in total.items() if coefficient}


def vector(name: str) -> list[dict]:
    """Three variables."""
    return [variable(f"{name}{axis}") for axis in "xyz"]


def minus(x: list[dict], y: list[dict]) -> list[dict]:
    """x - y."""
    return [plus(a, b, -1) for a, b in zip(x, y, strict=True)]


def minor(x: list[dict], y: list[dict], k: int) -> dict:
    """Component k of x cross y."""
    i, j = (k + 1) % 3, (k + 2) % 3
    return plus(times(x[i], y[j]), times(x[j], y[i]), -1)


def determinant(*rows: list[dict]) -> dict:
    """By Leibniz's formula."""
    total = {}
    for order in itertools.permutations(range(3)):
        sign = 1 if order in ((0, 1, 2), (1, 2, 0), (2, 0, 1)) else -1
        total = plus(total, times(times(rows[0][order[0]], rows[1][order[1]]), rows[2][order[2]]), sign)
    return total


O, I, L = vector("O"), vector("I"), variable("limit")
A, B, C, D, E, F = (vector(name) for name in "ABCDEF")
PLACES = dict(zip(range(25), [*O, *I, *A, *B, *C, *D, *E, *F, L], strict=True)) | {
    FLOATS["one"]: variable("one"), FLOATS["zero"]: {}}


def listed() -> tuple[dict[str, int], list[Instruction]]:
    """The entries and the instructions of the package, as the hardware reads them."""
    text = exact_program.FILE.read_text()
    entries = {name: int(place) for name, place in re.findall(r"localparam logic \[6:0\] (\w+) = 7'd(\d+);", text)}
    words = [word.replace("_", "") for word in re.findall(r"7'd\d+: instruction = 41'b([01_]+);", text)]
    instructions = []
    for word in words:
        kind, flags, places = int(word[:3], 2), word[3:6], [int(word[k:k + 5], 2) for k in range(6, 41, 5)]
        terms = [(places[k], places[k - 1]) for k in (6, 4, 2)]
        instructions.append(Instruction(KINDS[kind], places[0], terms, *(flag == "1" for flag in flags)))
    return entries, instructions


class Run:
    """Instructions from an entry on, with polynomials for numbers: the signs that they ask for, in order."""

    def __init__(self, entry: str, numbers: dict | None = None):
        entries, instructions = listed()
        self.numbers = {} if numbers is None else numbers
        self.asked, self.normals = [], []
        for one in instructions[entries[entry]:]:
            total = self.value(one)
            if one.decide:
                self.asked.append((one.kind, total))
                self.normals.append([self.numbers[one.terms[k][1]] for k in range(3)] if one.kind == "edge" else None)
            else:
                self.numbers[one.result] = total
            if one.last or one.kind == "compare":
                break

    def value(self, one: Instruction) -> dict:
        """The sum of an instruction's terms."""
        if one.kind in ("coordinate", "ray", "pair"):
            return plus(PLACES[one.terms[0][0]], PLACES[one.terms[0][1]], -1)
        products = [times(self.numbers[x], self.numbers[y])
                    for x, y in one.terms[:3 if one.kind in ("plane", "edge") else 2]]
        if len(products) == 2:
            return plus(products[0], products[1], -1)
        return plus(plus(products[0], products[1]), products[2])


def fraction(corners: list[list[dict]]) -> tuple[dict, dict]:
    """t = D / S of a triangle's plane."""
    edges = minus(corners[1], corners[0]), minus(corners[2], corners[0])
    return determinant(minus(corners[0], O), *edges), determinant(I, *edges)


class ExactProgram(unittest.TestCase):
    """hw/exact/exact_program_pkg.sv."""

    def test_is_what_the_script_writes(self):
        self.assertEqual(exact_program.FILE.read_text(), exact_program.text())

    def test_hit(self):
        """The plane, then three edges, each with the normal that breaks its ties."""
        a, b, c = (minus(corner, O) for corner in (A, B, C))
        run = Run("Hit")
        edges = [(b, c), (c, a), (a, b)]
        self.assertEqual(run.asked, [("plane", determinant(a, b, c)), *(("edge", determinant(I, *edge)) for edge in edges)])
        self.assertEqual(run.normals[1:], [[minor(*edge, k) for k in range(3)] for edge in edges])

    def test_limit(self):
        distance, slope = fraction([A, B, C])
        wanted = plus(times(distance, variable("one")), times(slope, L), -1)
        for before in ({}, Run("Hit").numbers):
            run = Run("Limit", before)
            self.assertEqual(run.asked, [("compare", wanted)])
            self.assertEqual(run.numbers[NUMBERS["distance"]], distance)
            self.assertEqual(run.numbers[NUMBERS["other_distance"]], L)

    def test_order(self):
        (distance, slope), (other_distance, other_slope) = fraction([A, B, C]), fraction([D, E, F])
        wanted = plus(times(distance, other_slope), times(slope, other_distance), -1)
        for before in ({}, Run("Hit").numbers):
            run = Run("Order", before)
            self.assertEqual(run.asked, [("compare", wanted)])
            self.assertEqual(run.numbers[NUMBERS["distance"]], distance)
            self.assertEqual(run.numbers[NUMBERS["other_distance"]], other_distance)

    def test_the_page_says_how_long_requests_take(self):
        self.assertIn(exact_program.table(), (exact_program.FILE.parent / "README.md").read_text())

    def test_fences(self):
        """Every fence is needed: without it a digit is read too early."""
        lengths = exact_program.Lengths(1, 1, 1)
        fences = 0
        for name, program in exact_program.fenced().items():
            for place, one in enumerate(program):
                if one.fence:
                    without = copy.deepcopy(program)
                    without[place].fence = False
                    self.assertEqual(exact_program.unsafe(without, lengths, 1 if name == "Limit" else 3, False), place)
                    fences += 1
        self.assertGreater(fences, 0)


if __name__ == "__main__":
    unittest.main()
