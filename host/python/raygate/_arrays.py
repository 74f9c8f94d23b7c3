"""Checks of the arrays that callers pass. Invalid arrays raise an InputError of one line."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._raygate import InputError

Array = npt.NDArray[Any]


def plain(name: str, values: npt.ArrayLike) -> Array:
    """Returns `values` as an array of numbers. Raises InputError for masked elements and non-numbers."""
    if np.ma.is_masked(values):
        raise InputError(f"{name}: found masked elements, expected none: leave their rows out or fill them")
    try:
        array = np.asarray(values)
    except ValueError:
        raise InputError(f"{name}: found rows of different lengths, expected an array of numbers") from None
    if array.dtype.kind not in "fiu":
        kind = f"an array of {array.dtype}" if array.ndim else f"a value of type {type(values).__name__}"
        raise InputError(f"{name}: found {kind}, expected numbers")
    return array


def reals(name: str, values: npt.ArrayLike) -> Array:
    """Returns `values` as an array of float32 or float64. Other kinds of numbers become float64."""
    array = plain(name, values)
    return array if array.dtype in (np.float32, np.float64) else array.astype(np.float64)


def vectors(name: str, values: npt.ArrayLike, *, takes_one: bool = False) -> Array:
    """Returns `values` as float32 or float64 of shape (N, 3), in C order. `takes_one`: also takes one of shape (3,)."""
    array = reals(name, values)
    if takes_one and array.shape == (3,):
        array = array[None]
    if array.ndim != 2 or array.shape[1] != 3:
        raise InputError(f"{name}: found an array of shape {array.shape}, expected (N, 3)")
    return np.ascontiguousarray(array)


def rays(origins: npt.ArrayLike, directions: npt.ArrayLike) -> tuple[Array, Array]:
    """Returns origins and directions, each of shape (N, 3). One vector, of shape (3,) or (1, 3), serves all rays."""
    starts, ways = vectors("origins", origins, takes_one=True), vectors("directions", directions, takes_one=True)
    if len(starts) != len(ways) and 1 not in (len(starts), len(ways)):
        raise InputError(f"directions: found an array of shape {ways.shape}, expected {starts.shape}, as many as origins")
    starts, ways = np.broadcast_arrays(starts, ways)
    return np.ascontiguousarray(starts), np.ascontiguousarray(ways)


def check_finite(name: str, array: Array, each: str, exponent: int) -> None:
    """Raises InputError unless all numbers are finite with a magnitude of at most 2^exponent. `each`: what messages call a row."""
    wrong = ~(np.abs(array) <= np.float64(2.0 ** exponent)).all(axis=tuple(range(1, array.ndim)))
    if wrong.any():
        row = int(wrong.argmax())
        raise InputError(f"{name}: found {array[row].tolist()} in {each} {row}, expected finite numbers of at most 2^{exponent}")


def points(values: npt.ArrayLike, exponent: int) -> Array:
    """Returns points with the shape (N, 3); a single point may have the shape (3,). Coordinates beyond 2^exponent raise InputError."""
    array = vectors("points", values, takes_one=True)
    check_finite("points", array, "point", exponent)
    return array


def triangles(name: str, corners: Array) -> Array:
    """Returns corners of triangles, of shape (N, 3, 3), as rows of shape (3 N, 3), in C order."""
    if corners.ndim != 3 or corners.shape[1:] != (3, 3) or not 0 < len(corners) < 2 ** 29:
        raise InputError(f"{name}: found an array of shape {corners.shape}, expected (N, 3, 3), N from 1 to 2^29 - 1")
    check_finite(name, corners, "triangle", 125)
    return np.ascontiguousarray(corners).reshape(-1, 3)


def vertex_numbers(faces: npt.ArrayLike | None, count: int, name: str = "faces") -> Array:
    """Returns `faces` as an array of shape (M, 3). Raises InputError unless all numbers are whole and from 0 to `count` - 1."""
    if faces is None:
        raise InputError(f"{name}: found None, expected the numbers of three vertices in each row")
    array = plain(name, faces)
    if array.ndim != 2 or array.shape[1] != 3 or array.dtype.kind == "f" or not len(array):
        raise InputError(f"{name}: found an array of {array.dtype} of shape {array.shape}, expected whole numbers, shape (M, 3), M > 0")
    wrong = ((array < 0) | (array >= count)).any(axis=1)
    if wrong.any():
        row = wrong.argmax()
        raise InputError(f"{name}: found {array[row].tolist()} in face {row}, expected numbers from 0 to {count - 1}")
    return array


def point(name: str, values: npt.ArrayLike | None) -> list[float] | None:
    """Returns three finite numbers, or None for None."""
    if values is None:
        return None
    array = reals(name, values)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise InputError(f"{name}: found {array.tolist()}, expected three finite numbers")
    return [float(number) for number in array]
