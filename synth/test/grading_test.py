"""Tests the paper's delay model, and the best group widths in this model."""

import itertools
import unittest

from synth import catalogue, grading, structure
from synth.structure import COUNTINGS, Counting


def delay(groups: tuple[int, ...], counting: Counting) -> float:
    """Returns the delay of a carry-select adder's last sum bit, computed from the definition of the delay model."""
    carry, slowest = None, 0.0
    for size in groups:
        ready = 0.0
        for _ in range(size):
            ready += 1
            at = ready if carry is None else max(ready, carry) + counting.last_multiplexer
            slowest = max(slowest, at)
        carry = ready if carry is None else max(ready, carry) + counting.multiplexer
    return slowest


def compositions(total: int) -> list[tuple[int, ...]]:
    """Returns all ways to cut `total` bits into groups."""
    found = []
    for cuts in itertools.product((0, 1), repeat=total - 1):
        groups, size = [], 1
        for cut in cuts:
            if cut:
                groups.append(size)
                size = 0
            size += 1
        found.append((*groups, size))
    return found


class Grading(unittest.TestCase):
    """Tests best_by_model."""

    def test_optimum_of_10_bits(self):
        """Dynamic programming finds the optimum of all 512 groupings."""
        for counting in COUNTINGS:
            found, groups = grading.best_by_model(10, counting)
            self.assertEqual(found, min(delay(g, counting) for g in compositions(10)))
            self.assertEqual(found, delay(groups, counting))

    def test_paper(self):
        """The best delay for 48 bits is 10 if the multiplexer of the sum bit is not counted, else 11."""
        self.assertEqual(grading.best_by_model(48, COUNTINGS[1])[0], 10)
        self.assertEqual(grading.best_by_model(48, COUNTINGS[0])[0], 11)

    def test_group_vector(self):
        """The lowest group is the lowest byte."""
        self.assertEqual(catalogue.group_widths([4, 5]), "128'h" + "0" * 28 + "0504")
        with self.assertRaises(ValueError):
            catalogue.group_widths([3] * 17)


def cell(kind: str, inputs: dict[str, int], outputs: dict[str, int]) -> dict:
    """Returns a cell in the form of Yosys's JSON, with ports of one bit."""
    return {"type": kind, "connections": {port: [bit] for port, bit in {**inputs, **outputs}.items()},
            "directions": {**dict.fromkeys(inputs, "input"), **dict.fromkeys(outputs, "output")}}


# Two chained full adders. The sum of the second adder goes through a multiplexer. Bits 2 to 5 are inputs.
MODULE = {
    "ports": {"a_i": {"direction": "input", "bits": [2, 3]}, "sum_o": {"direction": "output", "bits": [10, 12]}},
    "cells": [
        cell("FULL_ADDER", {"A": 2, "B": 4, "C": 5}, {"SUM": 10, "CARRY": 11}),
        cell("FULL_ADDER", {"A": 3, "B": 4, "C": 11}, {"SUM": 13, "CARRY": 14}),
        cell("MULTIPLEXER", {"WHEN_0": 13, "WHEN_1": 13, "SELECT": 5}, {"OUT": 12})]}


class Count(unittest.TestCase):
    """Tests structure.delay."""

    def test_countings(self):
        """The delay of the last multiplexer depends on the counting."""
        every, carries = COUNTINGS[:2]
        self.assertEqual(structure.delay(MODULE, every), 3)
        self.assertEqual(structure.delay(MODULE, carries), 2)

    def test_cells(self):
        """Counts the cells of each kind."""
        self.assertEqual(structure.hardware(MODULE), {"full_adder": 2, "multiplexer": 1, "gate": 0})
