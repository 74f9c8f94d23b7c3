"""Scenes of triangles: ray tracing, point queries, rendering."""

from __future__ import annotations

import functools
import os
from typing import Any, Iterable, Literal, Union, overload

import numpy as np
import numpy.typing as npt

from . import _arrays, _raygate
from ._context import in_context
from ._arrays import Array
from ._raygate import InputError

Path = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]
Degenerate = Literal["leave out", "refuse"]

_DIRECTION = np.array([0.36, 0.48, 0.8], np.float32)  # of rays that count crossings; arbitrary


class Picture(dict[str, Array]):
    """A rendered picture: a dictionary of arrays by name, from Scene.render. A notebook shows it as a PNG."""

    def __init__(self, channels: dict[str, Array], film: _raygate.Film) -> None:
        super().__init__(channels)
        self._film = film

    @in_context
    def save(self, file: Path, exposure: float = 0.0) -> None:
        """Writes a PNG or an OpenEXR file, depending on the ending of the name, .png or .exr. `exposure`: in stops, of
        a PNG; +1 doubles the brightness. Raises InputError for another ending, and OSError if the file cannot be
        written."""
        ending = os.path.splitext(os.fsdecode(file))[1].lower()
        if ending not in (".png", ".exr"):
            raise InputError(f"save: found {os.fsdecode(file)!r}, expected a name that ends in .png or .exr")
        data = self._film.exr() if ending == ".exr" else self.png(exposure)
        with open(file, "wb") as output:
            output.write(data)

    @in_context
    def png(self, exposure: float = 0.0) -> bytes:
        """Returns the bytes of a PNG file. `exposure`: in stops; +1 doubles the brightness."""
        return self._film.png(exposure)

    _repr_png_ = png


class Scene(_raygate.Scene):
    """Triangles, materials and lights. Pickling a scene keeps the absolute name of its file or copies of its arrays,
    and its options; unpickling reads the file or builds the scene again."""

    @overload
    def __init__(self, file: Path, /, *, smooth: float | None = None, degenerate: Degenerate = "leave out",
                 threads: int | None = None) -> None: ...

    @overload
    def __init__(self, vertices: npt.ArrayLike, /, faces: npt.ArrayLike, *, smooth: float | None = None,
                 degenerate: Degenerate = "leave out", threads: int | None = None) -> None: ...

    @in_context
    def __init__(self, file: Any, /, faces: npt.ArrayLike | None = None, *, smooth: float | None = None,
                 degenerate: Degenerate = "leave out", threads: int | None = None) -> None:
        """Reads a file: OBJ, glTF, PLY, STL or a scene file (JSON). Or takes arrays: vertices of shape (N, 3), float32
        or float64, and faces of shape (M, 3), whole numbers: three vertices, counted from 0, in each row.

        Triangles have the numbers of the faces. Faces without area keep their numbers, but no ray hits them;
        `degenerate_faces` lists them; degenerate="refuse" raises InputError for them. `smooth`: faces without normals
        that meet at no more than so many degrees are shaded smoothly. `threads`: one per processor by default. Raises
        InputError, a ValueError, which names the file and line, or the face, that cannot be used."""
        options = {"smooth": smooth, "degenerate": degenerate, "threads": threads}
        if faces is None and isinstance(file, (str, bytes, os.PathLike)):
            name = os.fsencode(file)
            if b"\0" in name:
                raise InputError(f"file: found {file!r}, expected a name without a null byte")
            self._recipe: tuple[Any, ...] = Scene, (os.path.abspath(name),), options
            super().__init__(name, _settings(**options))
            return
        vertices = np.array(_arrays.vectors("vertices", file))
        numbers = np.array(_arrays.vertex_numbers(faces, len(vertices)))
        self._recipe = Scene, (vertices, numbers), options
        super().__init__("faces", _arrays.triangles("faces", vertices[numbers]), _settings(**options))

    @classmethod
    @in_context
    def of_triangles(cls, corners: npt.ArrayLike, *, degenerate: Degenerate = "leave out",
                     threads: int | None = None) -> Scene:
        """Returns a scene of grey triangles from their corners, of shape (N, 3, 3), float32 or float64. Triangles
        without area are as in Scene(). Raises InputError, which names the triangle that cannot be used."""
        scene = cls.__new__(cls)
        kept = np.array(_arrays.reals("triangles", corners), order="C")
        options = {"degenerate": degenerate, "threads": threads}
        scene._recipe = cls.of_triangles, (kept,), options
        super(Scene, scene).__init__("triangles", _arrays.triangles("triangles", kept), _settings(**options))
        return scene

    def __reduce__(self) -> tuple[Any, ...]:
        make, arguments, options = self._recipe
        return functools.partial(make, **options), arguments

    @in_context
    def trace(self, origins: npt.ArrayLike, directions: npt.ArrayLike, limits: npt.ArrayLike | None = None, *,
              hits: Literal["nearest", "any", "all"] = "nearest", columns: str | Iterable[str] | None = None,
              threads: int | None = None) -> Array:
        """Returns the hits of rays: a structured array with a field for each answer.

        origins, directions: shape (N, 3); float64 in C order is read without a copy. One of them may be one vector for all
        rays, of shape (3,) or (1, 3). Hits are at origin + t direction, 0 < t < limit;
        directions need not have length 1. limits: shape (N,), or one number for all rays; none by default. hits:
        "nearest", a row for each ray; "any", a row for each ray that says whether it hits anything, which takes less
        time; "all", a row for each hit of each ray, near before far. columns: one or several of ray, hit, triangle,
        object, material, t, point (fields x, y, z), uv (u, v), normal (nx, ny, nz), side, doubts;
        host/docs/reference.md explains them. threads: one per processor by default.

        No rays, shape (0, 3), give no rows. Raises InputError for other shapes, masked elements and unknown names; for
        inf, NaN, directions of 0, limits that are not above 0 and origins farther than 2^126 from the scene it names
        the ray."""
        origins, directions = _arrays.rays(origins, directions)
        if limits is not None:
            limits = _arrays.reals("limits", limits)
            if limits.ndim == 0:
                limits = np.broadcast_to(limits, (len(origins),))
            if limits.shape != (len(origins),):
                raise InputError(f"limits: found an array of shape {limits.shape}, expected one number or one for each "
                                 f"ray, ({len(origins)},)")
            limits = np.ascontiguousarray(limits)
        if not isinstance(columns, (str, Iterable, type(None))):
            raise InputError(f"columns: found {columns!r}, expected a name or several names")
        names = [columns] if isinstance(columns, str) else [str(column) for column in columns or []]
        rows, fields = self._trace(origins, directions, limits, names, _settings(hits=hits, threads=threads))
        return rows.view(np.dtype(fields))

    @in_context
    def render(self, width: int | None = None, height: int | None = None, *, eye: npt.ArrayLike | None = None,
               target: npt.ArrayLike | None = None, up: npt.ArrayLike | None = None, **options: Any) -> Picture:
        """Returns a Picture: a dictionary of arrays of `height` rows, the top one first, and `width` columns, in
        pixels.

        "color", shape (height, width, 4): scene-linear R, G, B, A, premultiplied. "normal", "point", "albedo", shape
        (height, width, 3); "depth", shape (height, width): float32. "triangle" and "object", shape (height, width):
        uint32, 4294967295 where nothing is hit. eye, target, up: three numbers each, in the file's coordinates; the
        camera of the scene file by default, or one that sees the whole scene. Other keywords are options of ./render,
        with its defaults: spp, error, integrator, fov (degrees), depth, seed, filter, threshold, ambient, threads.
        Raises InputError, which names the option, for values that cannot be used."""
        channels, film = self._render(_arrays.point("eye", eye), _arrays.point("target", target), _arrays.point("up", up),
                                      _settings(width=width, height=height, **options))
        return Picture(channels, film)

    def _crossings(self, points: Array) -> Array:
        """Returns how often a ray from each point leaves surfaces, less how often it enters them."""
        hits = self.trace(points, _DIRECTION, hits="all", columns=["ray", "side"])
        return np.bincount(hits["ray"], hits["side"], minlength=len(points))

    @in_context
    def inside(self, points: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Returns whether points, of shape (N, 3), are inside of closed surfaces: an array of bool, of shape (N,). The
        answers are exact, for points as trace() rounds origins: they count how often a ray from the point leaves and
        enters surfaces. They have no meaning for an open surface or for a point on a surface. Raises InputError, which
        names the point, for inf, NaN and coordinates beyond 2^125."""
        is_inside: npt.NDArray[np.bool_] = self._crossings(_arrays.points(points, 125)) != 0
        return is_inside

    @in_context
    def winding_number(self, points: npt.ArrayLike) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Returns how often the surfaces wind around points, of shape (N, 3), and the largest error of each number: two
        arrays of float64, of shape (N,). Around a closed surface, also one that crosses itself, the number is whole and
        exact: 1 inside, 0 outside. Around an open one it is the solid angle seen from the point over 4 pi. The error is
        inf if a point is so near a surface that rounding, as of origins in trace(), may move it across. The numbers have
        no meaning for a point on a surface. Raises InputError as inside() does."""
        points = _arrays.points(points, 125)
        rows = self._winding(points, self._crossings(points), _DIRECTION.tolist()).view(np.float64)
        return rows[0::2].copy(), rows[1::2].copy()

    @in_context
    def closest(self, points: npt.ArrayLike) -> Array:
        """Returns the nearest points of the surface to points of shape (N, 3): a structured array of N rows with the
        fields triangle, int64, and distance, x, y and z, float64, in the scene's unit of length. Errors are those of
        rounding in float64. Of triangles at the same distance the lowest number is returned. Raises InputError, which
        names the point, for inf, NaN and coordinates beyond 2^1000."""
        points = _arrays.points(points, 1000)
        fields = [("triangle", "<i8"), *((name, "<f8") for name in ("distance", "x", "y", "z"))]
        return self._closest(points).view(np.dtype(fields))


def _settings(**options: object) -> list[tuple[str, str]]:
    """Returns keywords as the options of ./render: names and text, without those that are None."""
    return [(name, str(value)) for name, value in options.items() if value is not None]
