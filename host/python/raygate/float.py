"""IEEE 754 arithmetic in any small format, rounding mode and kind of tininess: value and flags.

    import numpy as np, raygate.float as rf
    rf.fp_add(0.1, 0.2)                     # 0.30000001192092896, INEXACT: in binary32
    rf.fp_divide(1, 3, rf.BINARY16).value   # 0.333251953125
    rf.fp_add(np.float32(1), np.float32(2 ** -24), rounding="up")   # 1.0000001, INEXACT
    rf.fp_multiply(np.uint32([0x7F7FFFFF]), np.uint32([0x40000000])).flag_names  # OVERFLOW|INEXACT

Operands are Python's numbers or lists of them, which are rounded to nearest to the format, with a
RoundingWarning; NumPy's arrays and scalars of floats or signed integers, which must be numbers of
the format (round_to makes them so); or of unsigned integers, which are the format's words: sign,
exponent, fraction. Results are of the kind of the operands. Arrays of different shapes are
broadcast.

What computes here is the reference that the simulated cores of hw/fp are compared with, bit by bit,
by this repository's tests (sim/test/fp). With `cores`, the path of the program float_cores of this
repository (cmake --build build --target float_cores), the cores themselves do, Verilated, in the
four formats below. NaNs that come out are the cores' only one, positive and quiet.
"""

import dataclasses
import enum
import os
import subprocess
import typing
import warnings

import numpy as np

from . import _raygate
from ._arithmetic import in_ieee_floats
from ._raygate import InputError

ROUNDINGS = ("nearest-even", "toward-zero", "down", "up", "nearest-away")
RELATIONS = ("==", "<", "<=")
_TININESS = ("after", "before")
_OPERATIONS = ("+", "-", "*", "/", *RELATIONS)


@dataclasses.dataclass(frozen=True)
class Format:
    """A sign, biased exponents of `exponent_bits` (2 to 11), fractions of `fraction_bits` (1 to
    29); 32 bits at most."""

    exponent_bits: int
    fraction_bits: int

    def __post_init__(self):
        if not (2 <= self.exponent_bits <= 11 and 1 <= self.fraction_bits <= 29
                and self.width <= 32):
            raise InputError(f"found {self}, expected 2 to 11 exponent bits, 1 to 29 fraction bits "
                             "and at most 32 bits in all")

    @property
    def width(self):
        """Bits of a word."""
        return 1 + self.exponent_bits + self.fraction_bits


BINARY32 = Format(8, 23)
BINARY16 = Format(5, 10)
BFLOAT16 = Format(8, 7)
FLOAT8 = Format(4, 3)


class Flags(enum.IntFlag):
    """Exceptions, as the bits of `flags`."""

    INEXACT = 1
    UNDERFLOW = 2
    OVERFLOW = 4
    DIVIDE_BY_ZERO = 8
    INVALID = 16


class RoundingWarning(UserWarning):
    """A number of Python's is none of the format, and was rounded to one."""


class Result(typing.NamedTuple):
    """What an operation gives."""

    value: np.ndarray
    flags: np.ndarray  #: of one result Flags; of several uint8, their bits

    @property
    def flag_names(self):
        """The flags in words, "OVERFLOW|INEXACT": a str, or an array of them."""
        names = np.array(["|".join(flag.name for flag in reversed(Flags) if bits & flag)
                          for bits in range(32)])
        return names[np.asarray(self.flags)]


@in_ieee_floats
def fp_add(a, b, format=BINARY32, rounding="nearest-even", tininess="after", cores=None):
    """a + b. `rounding` is one of ROUNDINGS; `tininess`, "before" or "after" rounding, is when a
    result counts as subnormal, which changes the flag UNDERFLOW alone. `cores`: the program
    float_cores, if the simulated cores are to compute."""
    return _run("+", a, b, format, rounding, tininess, cores)


@in_ieee_floats
def fp_subtract(a, b, format=BINARY32, rounding="nearest-even", tininess="after", cores=None):
    """a - b, as fp_add."""
    return _run("-", a, b, format, rounding, tininess, cores)


@in_ieee_floats
def fp_multiply(a, b, format=BINARY32, rounding="nearest-even", tininess="after", cores=None):
    """a * b, as fp_add."""
    return _run("*", a, b, format, rounding, tininess, cores)


@in_ieee_floats
def fp_divide(a, b, format=BINARY32, rounding="nearest-even", tininess="after", cores=None):
    """a / b, as fp_add."""
    return _run("/", a, b, format, rounding, tininess, cores)


@in_ieee_floats
def fp_compare(a, b, relation, format=BINARY32, cores=None):
    """Whether a `relation` b, one of RELATIONS, as an array of bool. "==" is quiet, the others
    signal INVALID for any NaN."""
    _one_of("relation", relation, RELATIONS)
    return _run(relation, a, b, format, "nearest-even", "after", cores)


@in_ieee_floats
def round_to(x, format=BINARY32, rounding="nearest-even", tininess="after"):
    """Numbers rounded to the format: floats, and the flags of it."""
    x = _numbers(x)
    bits, flags = encode(x, format, rounding, tininess)
    return Result(_held(decode(bits, format), x.dtype, format), flags)


@in_ieee_floats
def encode(x, format=BINARY32, rounding="nearest-even", tininess="after"):
    """As round_to, but the format's words, uint32."""
    x = _numbers(x)
    if x.dtype.kind != "f" or x.dtype.itemsize > 8:
        raise InputError(f"found an array of {x.dtype}, expected one of float16, float32 or float64")
    _one_of("rounding", rounding, ROUNDINGS)
    _one_of("tininess", tininess, _TININESS)
    flat = np.ascontiguousarray(x, np.float64).ravel()
    bits, flags = _raygate.float_encode(flat, format.exponent_bits, format.fraction_bits,
                                        ROUNDINGS.index(rounding), tininess == "before")
    return Result(bits.reshape(x.shape)[()], _flags(flags.reshape(x.shape)))


@in_ieee_floats
def decode(bits, format):
    """The numbers, float64, that words of the format stand for."""
    bits = _words(np.asarray(bits), format)
    field = bits >> format.fraction_bits & (1 << format.exponent_bits) - 1
    fraction = (bits & (1 << format.fraction_bits) - 1).astype(np.float64)
    bias = (1 << format.exponent_bits - 1) - 1
    one = np.float64(1 << format.fraction_bits)
    exponent = np.maximum(field, 1).astype(np.int64) - bias - format.fraction_bits
    size = np.ldexp(np.where(field == 0, fraction, fraction + one), exponent)
    special = np.where(fraction == 0, np.inf, np.nan)
    size = np.where(field == (1 << format.exponent_bits) - 1, special, size)
    return np.where(bits >> format.width - 1 == 1, -size, size)[()]


def _run(operation, a, b, format, rounding, tininess, cores):
    _one_of("rounding", rounding, ROUNDINGS)
    _one_of("tininess", tininess, _TININESS)
    operands = a, b
    a, b = _numbers(a), _numbers(b)
    kinds = {a.dtype.kind, b.dtype.kind}
    if kinds == {"u"}:
        words = _words(a, format), _words(b, format)
    elif kinds == {"f"}:
        words = tuple(_exact(array, format, is_pythons=not isinstance(x, (np.ndarray, np.generic)))
                      for array, x in zip((a, b), operands))
    else:
        raise InputError(f"found arrays of {a.dtype} and {b.dtype}, expected both of unsigned "
                         "integers (the format's words) or both of floats")
    try:
        x, y = np.broadcast_arrays(*words)
    except ValueError:
        raise InputError(f"found arrays of shape {a.shape} and {b.shape}, expected shapes that can "
                         "be broadcast together") from None
    x_words, y_words = np.ascontiguousarray(x).ravel(), np.ascontiguousarray(y).ravel()
    if cores is None:
        value, flags = _raygate.float_run(
            _OPERATIONS.index(operation), x_words, y_words, format.exponent_bits,
            format.fraction_bits, ROUNDINGS.index(rounding), tininess == "before")
    else:
        value, flags = _by_cores(cores, operation, x_words, y_words, format, rounding, tininess)
    if operation in RELATIONS:
        value = value != 0
    elif kinds == {"f"}:
        value = _held(decode(value, format), np.result_type(a, b), format)
    return Result(value.reshape(x.shape)[()], _flags(flags.reshape(x.shape)))


def _flags(flags):
    return Flags(int(flags)) if flags.ndim == 0 else flags


def _numbers(x):
    """An array; of whole numbers with a sign as floats."""
    array = np.asarray(x)
    if array.dtype.kind == "i":
        wide = array.astype(np.float64)
        if array.size and (np.abs(wide) >= 2.0 ** 53).any():
            raise InputError(f"found {int(array.flat[np.abs(wide).argmax()])}, expected a whole number "
                             "below 2^53")
        return wide
    return array


def _by_cores(cores, operation, x, y, format, rounding, tininess):
    """Result and flags, by the program float_cores."""
    words = [os.fsdecode(cores), operation, str(format.exponent_bits), str(format.fraction_bits),
             str(ROUNDINGS.index(rounding)), str(int(tininess == "before"))]
    try:
        done = subprocess.run(words, input=np.stack([x, y], axis=1).astype("<u4").tobytes(),
                              capture_output=True)
    except OSError as error:
        raise InputError(f"cores: found {cores}, expected the program float_cores ({error.strerror})") from None
    if done.returncode != 0:
        raise InputError(done.stderr.decode(errors="replace").strip())
    pairs = np.frombuffer(done.stdout, "<u4").reshape(-1, 2).astype(np.uint32)
    return pairs[:, 0].copy(), pairs[:, 1].astype(np.uint8)


def _words(array, format):
    if array.dtype.kind != "u":
        raise InputError(f"found an array of {array.dtype}, expected one of unsigned integers")
    if array.size and int(array.max()) >> format.width:
        raise InputError(f"found the word {int(array.max()):#x}, expected {format.width} bits")
    return array.astype(np.uint32)


def _exact(array, format, is_pythons):
    """The words of floats: those of Python rounded, others must be numbers of the format."""
    bits, flags = encode(array, format)
    if np.any(flags):
        wrong = np.atleast_1d(array)[np.atleast_1d(flags) != 0].flat[0]
        if not is_pythons:
            raise InputError(f"found {wrong}, which is no number of {format}: round_to makes it one")
        taken = decode(np.atleast_1d(bits)[np.atleast_1d(flags) != 0][:1], format)[0]
        warnings.warn(f"{wrong} is no number of {format}: taken as {taken}, the nearest one",
                      RoundingWarning, stacklevel=6)
    return np.asarray(bits)


def _held(values, dtype, format):
    """As `dtype`, if that holds the format's numbers; else float64."""
    info = np.finfo(dtype)
    fits = format.fraction_bits <= info.nmant and format.exponent_bits <= info.nexp
    return np.asarray(values).astype(dtype if fits else np.float64)[()]


def _one_of(name, found, expected):
    if found not in expected:
        raise InputError(f"{name}: found {found!r}, expected one of {', '.join(expected)}")
