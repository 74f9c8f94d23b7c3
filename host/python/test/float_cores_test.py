"""raygate.float by the Verilated cores: the same bits and flags as by the reference."""

import os
import pathlib
import unittest

import numpy as np

import raygate
import raygate.float as rf

CORES = os.environ.get("RAYGATE_FLOAT_CORES",
                       pathlib.Path(__file__).parents[3] / "build" / "sim" / "float_cores")
FUNCTIONS = (rf.fp_add, rf.fp_subtract, rf.fp_multiply, rf.fp_divide)


class Cores(unittest.TestCase):
    def words(self, form, count):
        """Of all kinds: a third with exponents of all zeros or ones, or next to them."""
        rng = np.random.default_rng(form.width)
        words = rng.integers(0, 1 << form.width, (2, count), dtype=np.uint64).astype(np.uint32)
        ones = (1 << form.exponent_bits) - 1
        ends = rng.choice(np.array([0, 1, ones - 1, ones], np.uint32), (2, count))
        field = np.uint32(ones << form.fraction_bits)
        at_end = (words & ~field) | (ends << np.uint32(form.fraction_bits))
        return np.where(rng.random((2, count)) < 1 / 3, at_end, words)

    def test_they_give_the_references_bits_and_flags(self):
        for form in (rf.BINARY32, rf.BINARY16, rf.BFLOAT16, rf.FLOAT8):
            a, b = self.words(form, 20_000)
            for rounding in rf.ROUNDINGS:
                for tininess in ("before", "after"):
                    for function in FUNCTIONS:
                        ours = function(a, b, form, rounding, tininess)
                        theirs = function(a, b, form, rounding, tininess, cores=CORES)
                        np.testing.assert_array_equal(theirs.value, ours.value)
                        np.testing.assert_array_equal(theirs.flags, ours.flags)
            for relation in rf.RELATIONS:
                ours, theirs = (rf.fp_compare(a, b, relation, form, cores=cores) for cores in (None, CORES))
                np.testing.assert_array_equal(theirs.value, ours.value)
                np.testing.assert_array_equal(theirs.flags, ours.flags)

    def test_floats_too(self):
        self.assertEqual(rf.fp_divide([1.0], [3.0], rf.BINARY16, cores=CORES).value, 0.333251953125)
        self.assertEqual(rf.fp_add(np.uint32([]), np.uint32([]), cores=CORES).value.shape, (0,))

    def test_says_what_is_wrong(self):
        with self.assertRaisesRegex(raygate.InputError, "float_cores: expected a format of 8 and 23"):
            rf.fp_add([1.0], [1.0], rf.Format(6, 10), cores=CORES)
        with self.assertRaisesRegex(raygate.InputError, "cores: found none, expected the program"):
            rf.fp_add([1.0], [1.0], cores="none")


if __name__ == "__main__":
    unittest.main()
