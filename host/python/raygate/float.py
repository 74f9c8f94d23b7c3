"""IEEE 754 arithmetic in any small format, rounding mode and kind of tininess: value and flags.

    import numpy as np, raygate.float as rf
    rf.fp_add(0.1, 0.2)                     # Result(0.30000001192092896, INEXACT): in binary32, with a RoundingWarning
    rf.fp_divide(1, 3, rf.BINARY16).value   # 0.333251953125
    rf.fp_add(np.float32(1), np.float32(2 ** -24), rounding="up")   # 1.0000001, INEXACT
    rf.fp_multiply(np.uint32([0x7F7FFFFF]), np.uint32([0x40000000])).flag_names  # OVERFLOW|INEXACT

There are three kinds of operands. Python's numbers, or lists of them, are rounded to the nearest number of the format, with a
RoundingWarning. NumPy's arrays and scalars of floats or signed integers must be numbers of the format, as returned by round_to.
NumPy's unsigned integers are words of the format: sign, exponent, fraction. Results have the kind of the operands. Arrays of
any shape are broadcast; empty ones give empty results. Masked elements and other operands raise an InputError.

Results are those of the reference model that this repository's tests (sim/test/fp) compare with the simulated cores of
hw/fp, bit by bit. A NaN result is always the positive quiet NaN.
"""

from __future__ import annotations

import dataclasses
import enum
import functools
import warnings
from typing import Any, Callable, Literal, NamedTuple, Sequence, get_args

import numpy as np
import numpy.typing as npt

from . import _arrays, _raygate
from ._context import in_context
from ._arrays import Array
from ._raygate import InputError

Rounding = Literal["nearest-even", "toward-zero", "down", "up", "nearest-away"]
Tininess = Literal["after", "before"]
Relation = Literal["==", "<", "<="]

ROUNDINGS: tuple[Rounding, ...] = get_args(Rounding)
RELATIONS: tuple[Relation, ...] = get_args(Relation)
_OPERATIONS = ("+", "-", "*", "/", *RELATIONS)


@dataclasses.dataclass(frozen=True)
class Format:
    """A binary format: a sign, `exponent_bits` of biased exponent (2 to 11) and `fraction_bits` of fraction (1 to 29),
    at most 32 bits in all. Raises InputError for others."""

    exponent_bits: int
    fraction_bits: int

    def __post_init__(self) -> None:
        whole = isinstance(self.width, int | np.integer)
        if not (whole and 2 <= self.exponent_bits <= 11 and 1 <= self.fraction_bits <= 29 and self.width <= 32):
            raise InputError(f"found {self}, expected 2 to 11 exponent bits, 1 to 29 fraction bits and at most 32 bits in all")

    @property
    def width(self) -> int:
        """Number of bits of a word."""
        return 1 + self.exponent_bits + self.fraction_bits


BINARY32 = Format(8, 23)
BINARY16 = Format(5, 10)
BFLOAT16 = Format(8, 7)
FLOAT8 = Format(4, 3)


class Flags(enum.IntFlag):
    """Exceptions of IEEE 754, the bits of `flags`."""

    INEXACT = 1
    UNDERFLOW = 2
    OVERFLOW = 4
    DIVIDE_BY_ZERO = 8
    INVALID = 16


class RoundingWarning(UserWarning):
    """A Python number was rounded to the nearest number of the format."""


class Result(NamedTuple):
    """The result of an operation."""

    value: Any  #: a NumPy scalar, or an array of the operands' shape
    flags: Any  #: Flags for a scalar; for an array their bits, uint8, of the same shape

    @property
    def flag_names(self) -> Any:
        """The flags as text, "OVERFLOW|INEXACT": a str, or an array of str."""
        names = np.array(["|".join(str(flag.name) for flag in reversed(Flags) if bits & flag) for bits in range(32)])
        return names[np.asarray(self.flags)]


@in_context
def fp_add(a: npt.ArrayLike, b: npt.ArrayLike, format: Format = BINARY32, rounding: Rounding = "nearest-even",
           tininess: Tininess = "after") -> Result:
    """Returns a + b. `rounding`: one of ROUNDINGS. `tininess`: whether the size of a result is judged "before" or "after" rounding; it
    affects the flag UNDERFLOW alone. Raises InputError for operands that are not numbers of the format and shapes that do not
    broadcast."""
    return _run("+", a, b, format, rounding, tininess)


@in_context
def fp_subtract(a: npt.ArrayLike, b: npt.ArrayLike, format: Format = BINARY32, rounding: Rounding = "nearest-even",
                tininess: Tininess = "after") -> Result:
    """Returns a - b. Arguments: see fp_add."""
    return _run("-", a, b, format, rounding, tininess)


@in_context
def fp_multiply(a: npt.ArrayLike, b: npt.ArrayLike, format: Format = BINARY32, rounding: Rounding = "nearest-even",
                tininess: Tininess = "after") -> Result:
    """Returns a * b. Arguments: see fp_add."""
    return _run("*", a, b, format, rounding, tininess)


@in_context
def fp_divide(a: npt.ArrayLike, b: npt.ArrayLike, format: Format = BINARY32, rounding: Rounding = "nearest-even",
              tininess: Tininess = "after") -> Result:
    """Returns a / b. Arguments: see fp_add."""
    return _run("/", a, b, format, rounding, tininess)


@in_context
def fp_compare(a: npt.ArrayLike, b: npt.ArrayLike, relation: Relation, format: Format = BINARY32) -> Result:
    """Returns `a relation b`, as bool. `relation`: one of RELATIONS; "==" is quiet, the others signal INVALID
    for any NaN. Other arguments: see fp_add."""
    _one_of("relation", relation, RELATIONS)
    return _run(relation, a, b, format, "nearest-even", "after")


@in_context
def round_to(x: npt.ArrayLike, format: Format = BINARY32, rounding: Rounding = "nearest-even", tininess: Tininess = "after") -> Result:
    """Returns numbers rounded to the format, as floats of their own type, or as float64 if this type cannot hold the format, and the
    flags of the rounding. Arguments: see fp_add."""
    x = _numbers(x)
    bits, flags = encode(x, format, rounding, tininess)
    return Result(_held(decode(bits, format), x.dtype, format), flags)


@in_context
def encode(x: npt.ArrayLike, format: Format = BINARY32, rounding: Rounding = "nearest-even", tininess: Tininess = "after") -> Result:
    """Returns numbers rounded to the format, as words, uint32, and the flags of the rounding. Arguments: see fp_add."""
    x = _numbers(x)
    if x.dtype.kind != "f" or x.dtype.itemsize > 8:
        raise InputError(f"found an array of {x.dtype}, expected one of float16, float32 or float64")
    return _results(_raygate.float_encode, [np.asarray(x, np.float64)], format, rounding, tininess)


@in_context
def decode(bits: npt.ArrayLike, format: Format) -> Any:
    """Returns the values, float64, of words of the format. Raises InputError unless the words are unsigned integers that fit."""
    bits = _words(_arrays.plain("bits", bits), format)
    highest = (1 << format.exponent_bits) - 1
    field = bits >> format.fraction_bits & highest
    fraction = (bits & (1 << format.fraction_bits) - 1).astype(np.float64)
    bias = (1 << format.exponent_bits - 1) - 1
    exponent = np.maximum(field, 1).astype(np.int64) - bias - format.fraction_bits
    size = np.ldexp(fraction + (field > 0) * 2.0 ** format.fraction_bits, exponent)
    size = np.where(field == highest, np.where(fraction == 0, np.inf, np.nan), size)
    return np.where(bits >> format.width - 1 == 1, -size, size)[()]


def _run(operation: str, a: npt.ArrayLike, b: npt.ArrayLike, format: Format, rounding: Rounding, tininess: Tininess) -> Result:
    operands = a, b
    a, b = _numbers(a), _numbers(b)
    kinds = {a.dtype.kind, b.dtype.kind}
    if kinds == {"u"}:
        words: tuple[Array, ...] = _words(a, format), _words(b, format)
    elif kinds == {"f"}:
        words = tuple(_exact(array, format, is_pythons=not isinstance(x, (np.ndarray, np.generic))) for array, x in zip((a, b), operands))
    else:
        raise InputError(f"found arrays of {a.dtype} and {b.dtype}, expected both of unsigned "
                         "integers (the format's words) or both of floats")
    try:
        x, y = np.broadcast_arrays(*words)
    except ValueError:
        raise InputError(f"found arrays of shape {a.shape} and {b.shape}, expected shapes that can be broadcast together") from None
    compute = functools.partial(_raygate.float_run, _OPERATIONS.index(operation))
    value, flags = _results(compute, [x, y], format, rounding, tininess)
    if operation in RELATIONS:
        value = value != 0
    elif kinds == {"f"}:
        value = _held(decode(value, format), np.result_type(a, b), format)
    return Result(value, flags)


def _results(compute: Callable[..., Array], operands: Sequence[Array], format: Format, rounding: Rounding, tininess: Tininess) -> Result:
    """Returns the words and flags that `compute`, of the C++ half, returns for operands of one shape."""
    _one_of("rounding", rounding, ROUNDINGS)
    _one_of("tininess", tininess, get_args(Tininess))
    _one_of("format", type(format).__name__, ["Format"])
    columns = [np.ascontiguousarray(operand).ravel() for operand in operands]
    rows = compute(*columns, format.exponent_bits, format.fraction_bits, ROUNDINGS.index(rounding), tininess == "after")
    fields = np.dtype([("bits", np.uint32), ("flags", np.uint8)], align=True)
    results = rows.view(fields).reshape(operands[0].shape)
    return Result(results["bits"].copy()[()], results["flags"].copy() if results.ndim else Flags(int(results["flags"])))


def _numbers(x: npt.ArrayLike) -> Array:
    """Returns an array; signed integers become float64."""
    array = np.array(x, object) if type(x) is int and abs(x) < 2**1000 else _arrays.plain("operand", x)
    if array.dtype.kind in "iO":
        wide = array.astype(np.float64)
        if array.size and (np.abs(wide) >= 2.0 ** 53).any():
            raise InputError(f"found {int(array.flat[np.abs(wide).argmax()])}, expected a whole number below 2^53")
        return wide
    return array


def _words(array: Array, format: Format) -> Array:
    _one_of("format", type(format).__name__, ["Format"])
    if array.dtype.kind != "u":
        raise InputError(f"found an array of {array.dtype}, expected one of unsigned integers")
    if array.size and int(array.max()) >> format.width:
        raise InputError(f"found the word {int(array.max()):#x}, expected {format.width} bits")
    return array.astype(np.uint32)


def _exact(array: Array, format: Format, is_pythons: bool) -> Array:
    """Returns the words of floats. Rounds them if `is_pythons`; otherwise they must be numbers of the format."""
    bits, flags = encode(array, format)
    if np.any(flags):
        wrong = np.atleast_1d(array)[np.atleast_1d(flags) != 0].flat[0]
        if not is_pythons:
            raise InputError(f"found {wrong}, which is no number of {format}: round_to makes it one")
        taken = decode(np.atleast_1d(bits)[np.atleast_1d(flags) != 0][:1], format)[0]
        warnings.warn(f"{wrong} is no number of {format}: taken as {taken}, the nearest one", RoundingWarning, stacklevel=6)
    return np.asarray(bits)


def _held(values: Array, dtype: np.dtype[Any], format: Format) -> Any:
    """Returns `values` as `dtype` if it holds all numbers of the format, else as float64."""
    info = np.finfo(dtype)
    fits = format.fraction_bits <= info.nmant and format.exponent_bits <= info.nexp
    return np.asarray(values).astype(dtype if fits else np.float64)[()]


def _one_of(name: str, found: str, expected: Sequence[str]) -> None:
    if found not in expected:
        raise InputError(f"{name}: found {found!r}, expected one of {', '.join(expected)}")
