"""Compares raygate.float with the machine's own arithmetic where the machine has the format."""

import unittest
import warnings

import numpy as np

import raygate.float as rf

rng = np.random.default_rng(1)
WORDS16 = rng.integers(0, 1 << 16, (2, 200_000)).astype(np.uint16)
WORDS32 = rng.integers(0, 1 << 32, (2, 200_000), dtype=np.uint64).astype(np.uint32)
ARITHMETIC = {"add": rf.fp_add, "subtract": rf.fp_subtract, "multiply": rf.fp_multiply, "divide": rf.fp_divide}


class Operations(unittest.TestCase):
    def test_words_are_the_machines(self):
        for words, kind, form in ((WORDS16, np.float16, rf.BINARY16),
                                  (WORDS32, np.float32, rf.BINARY32)):
            a, b = words.view(kind)
            with np.errstate(all="ignore"):
                for name, function in ARITHMETIC.items():
                    expected = getattr(np, name)(a, b)
                    value = function(*words, form).value
                    self.assertEqual(value.dtype, np.uint32)
                    is_nan = np.isnan(expected)
                    self.assertTrue((value[is_nan] == ((1 << form.exponent_bits + 1) - 1) << form.fraction_bits - 1).all())
                    np.testing.assert_array_equal(value[~is_nan], expected.view(words.dtype)[~is_nan])
            for relation, function in (("==", np.equal), ("<", np.less), ("<=", np.less_equal)):
                np.testing.assert_array_equal(rf.fp_compare(*words, relation, form).value, function(a, b))

    def test_floats_are_their_words(self):
        a, b = WORDS16.view(np.float16)
        finite = np.isfinite(a) & np.isfinite(b)
        words = rf.fp_multiply(*WORDS16[:, finite], rf.BINARY16)
        floats = rf.fp_multiply(a[finite], b[finite], rf.BINARY16)
        self.assertEqual(floats.value.dtype, np.float16)
        np.testing.assert_array_equal(floats.value.view(np.uint16), words.value)
        np.testing.assert_array_equal(floats.flags, words.flags)

    def test_rounding_and_flags(self):
        one, tiny = np.float32(1), np.float32(2.0**-24)
        for rounding, expected in (("nearest-even", 1), ("toward-zero", 1), ("down", 1),
                                   ("up", 1 + 2.0**-23), ("nearest-away", 1 + 2.0**-23)):
            value, flags = rf.fp_add(one, tiny, rounding=rounding)
            self.assertEqual((value, flags), (expected, rf.Flags.INEXACT))
        largest = np.float32(np.finfo(np.float32).max)
        self.assertEqual(rf.fp_add(largest, largest).flags, rf.Flags.OVERFLOW | rf.Flags.INEXACT)
        self.assertEqual(rf.fp_divide(1.0, 0.0).flags, rf.Flags.DIVIDE_BY_ZERO)
        self.assertEqual(rf.fp_divide(0.0, 0.0).flags, rf.Flags.INVALID)
        self.assertEqual(rf.fp_compare(np.nan, 1.0, "==").flags, 0)
        self.assertEqual(rf.fp_compare(np.nan, 1.0, "<").flags, rf.Flags.INVALID)
        # The product rounds up to the least normal number: it is tiny before rounding, not after.
        a, b = np.uint32(0x00FFFFFE), np.uint32(0x3F000001)
        self.assertEqual(rf.fp_multiply(a, b).flags, rf.Flags.INEXACT)
        self.assertEqual(rf.fp_multiply(a, b, tininess="before").flags, rf.Flags.INEXACT | rf.Flags.UNDERFLOW)

    def test_takes_pythons_numbers(self):
        with self.assertWarnsRegex(rf.RoundingWarning, "0.1 is no number of .*: taken as 0.100000001") as said:
            value, flags = rf.fp_add(0.1, 0.2)
        self.assertEqual(said.filename, __file__)
        self.assertEqual(value, float(np.float32(0.1) + np.float32(0.2)))
        self.assertIs(flags, rf.Flags.INEXACT)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(rf.fp_divide(1, 3).value, float(np.float32(1) / np.float32(3)))
            self.assertEqual(rf.fp_add([1, 2], 0.5).value.tolist(), [1.5, 2.5])
            self.assertEqual(rf.round_to(0.1).value, float(np.float32(0.1)))
        self.assertEqual(rf.fp_divide(1, 0).flag_names, "DIVIDE_BY_ZERO")
        self.assertEqual(rf.fp_add(1, 1).flag_names, "")
        many = rf.fp_multiply(np.float32([3e38, 1]), np.float32([3e38, 1]))
        self.assertEqual(many.flag_names.tolist(), ["OVERFLOW|INEXACT", ""])

    def test_any_format(self):
        form = rf.Format(3, 2)  # all of it
        words = np.arange(1 << form.width, dtype=np.uint8)
        numbers = rf.decode(words, form)
        a, b = np.meshgrid(numbers, numbers)
        with np.errstate(all="ignore"):
            exact = a * b
        products = rf.fp_multiply(*np.meshgrid(words, words), form, rounding="toward-zero").value
        got = rf.decode(products, form)
        for x, y in zip(exact.ravel(), got.ravel()):
            finite = numbers[np.isfinite(numbers)]
            nearest = (x if np.isnan(x) or np.isinf(x) else np.copysign(np.abs(finite)[np.abs(finite) <= abs(x)].max(), x))
            np.testing.assert_equal(y, nearest)

    def test_round_to(self):
        value, flags = rf.round_to([0.1, 0.5, 1e9, np.inf, -0.0], rf.BINARY16)
        np.testing.assert_array_equal(value, [np.float16(0.1), 0.5, np.inf, np.inf, -0.0])
        np.testing.assert_array_equal(flags, [1, 0, 5, 0, 0])
        self.assertTrue(np.signbit(value[4]))
        x = rng.normal(size=100_000) * 10.0 ** rng.uniform(-45, 38, 100_000)
        np.testing.assert_array_equal(rf.encode(x, rf.BINARY32).value, x.astype(np.float32).view(np.uint32))
        np.testing.assert_array_equal(rf.decode(WORDS16[0], rf.BINARY16), WORDS16[0].view(np.float16).astype(np.float64))

    def test_broadcasts(self):
        self.assertEqual(rf.fp_add(np.ones((3, 1)), np.ones(4)).value.shape, (3, 4))
        self.assertEqual(rf.fp_add(np.ones(0), np.ones(0)).value.shape, (0,))

    def test_says_what_it_cannot_use(self):
        for expected, call in (
                ("below 2\\^53", lambda: rf.fp_add([1 << 60], 2)),
                ("found 9223372036854775808, expected a whole number below 2\\^53", lambda: rf.fp_add(1 << 63, 2)),
                ("found -1180591620717411303424, expected a whole number", lambda: rf.fp_add(1.0, -1 << 70)),
                ("found a value of type bool", lambda: rf.fp_add(True, 1)),
                ("5.5.*expected 2 to 11 exponent bits", lambda: rf.Format(5.5, 10)),  # type: ignore[arg-type]
                ("^operand: found a value of type str, expected numbers$", lambda: rf.fp_add("1", 2.0)),
                ("float64 and uint32", lambda: rf.fp_add([1.0], np.uint32([2]))),
                ("found 0.1, which is no number", lambda: rf.fp_add(np.float64(0.1), 0.5, rf.BINARY16)),
                ("word 0x10000, expected 16 bits", lambda: rf.fp_add(
                    np.uint32([65536]), np.uint32([0]), rf.BINARY16)),
                ("rounding: found 'near'", lambda: rf.fp_add(1.0, 1.0, rounding="near")),
                ("tininess: found 'x'", lambda: rf.fp_add(1.0, 1.0, tininess="x")),
                ("relation: found '>'", lambda: rf.fp_compare(1.0, 1.0, ">")),
                (r"shape \(2,\) and \(3,\)", lambda: rf.fp_add(np.ones(2), np.ones(3))),
                ("at most 32 bits", lambda: rf.Format(8, 24)),
                ("unsigned", lambda: rf.decode([1.0], rf.BINARY16))):
            with self.assertRaisesRegex(ValueError, expected) as caught:
                call()
            self.assertNotIn("\n", str(caught.exception))


if __name__ == "__main__":
    unittest.main()
