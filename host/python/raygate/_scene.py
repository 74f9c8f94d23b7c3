"""Scenes of triangles: ray tracing, point queries, rendering."""

from __future__ import annotations

import functools
import os
from typing import TYPE_CHECKING, Any, Iterable, Literal, TypedDict, Union, overload

import numpy as np
import numpy.typing as npt

from . import _arrays, _raygate
from ._context import in_context
from ._arrays import Array
from ._raygate import InputError

if TYPE_CHECKING:
    from typing_extensions import Unpack

Path = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]
Degenerate = Literal["leave out", "refuse"]
RenderOptions = TypedDict("RenderOptions", {"spp": int, "error": float, "depth": int, "seed": int, "fov": float, "threads": int,
    "integrator": Literal["primary", "whitted", "path"], "filter": Literal["box", "blackman-harris"], "caustics": Literal["auto", "off"],
    "threshold": float, "ambient": float}, total=False)

_DIRECTION = np.array([0.36, 0.48, 0.8], np.float32)  # of the rays that count crossings; an arbitrary choice


class Picture(dict[str, Array]):
    """A rendered picture, from Scene.render: a dictionary of arrays by name. A notebook shows it as a PNG."""

    def __init__(self, channels: dict[str, Array], film: _raygate.Film) -> None:
        super().__init__(channels)
        self._film = film

    @in_context
    def save(self, file: Path, exposure: float = 0.0) -> None:
        """Writes a PNG or an OpenEXR file: the name ends in .png or .exr. `exposure`: of a PNG, in stops; +1 doubles the
        brightness. Raises InputError for another ending, and OSError if the file cannot be written."""
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

    def __repr__(self) -> str:
        height, width = self["depth"].shape
        return f"<raygate.Picture: {width} x {height} pixels; {', '.join(self)}>"


class Scene(_raygate.Scene):
    """Triangles, materials and lights. A pickle holds the absolute name of the file, or the arrays, and the options to rebuild it."""

    @overload
    def __init__(self, file: Path, /, *, smooth: float | None = None, degenerate: Degenerate = "leave out",
                 threads: int | None = None) -> None: ...

    @overload
    def __init__(self, vertices: npt.ArrayLike, /, faces: npt.ArrayLike, *, smooth: float | None = None,
                 degenerate: Degenerate = "leave out", threads: int | None = None) -> None: ...

    @in_context
    def __init__(self, file_or_vertices: Any, /, faces: npt.ArrayLike | None = None, *, smooth: float | None = None,
                 degenerate: Degenerate = "leave out", threads: int | None = None) -> None:
        """Reads a file: OBJ, glTF, PLY, STL or a scene file (JSON). Unlike ./render, it does not read a.json beside a.obj. Or takes
        vertices, shape (N, 3), float32 or float64, and faces, shape (M, 3): whole numbers of each face's vertices, from 0.

        Triangles have the numbers of the faces. Faces without area keep their numbers, but no ray hits them; `degenerate_faces` lists
        them. A scene needs a face with an area; degenerate="refuse" raises InputError for any face without area. `smooth`: faces without
        normals that meet at up to this angle, 0 to 180 degrees, are shaded smoothly. `threads`: 1 to 1024, one per processor by default.
        Raises InputError that names the file and line, the vertex or the face that cannot be used."""
        options = {"smooth": smooth, "degenerate": degenerate, "threads": threads}
        if faces is None and isinstance(file_or_vertices, (str, bytes, os.PathLike)):
            name = os.fsencode(file_or_vertices)
            if b"\0" in name:
                raise InputError(f"file: found {file_or_vertices!r}, expected a name without a null byte")
            self._recipe: tuple[Any, ...] = Scene, (os.path.abspath(name),), options
            super().__init__(name, _settings(**options))
            return
        vertices = np.array(_arrays.vectors("vertices", file_or_vertices))
        numbers = np.array(_arrays.vertex_numbers(faces, len(vertices)))
        is_used = np.isin(np.arange(len(vertices)), numbers)  # others may be NaN
        _arrays.check_finite("vertices", np.where(is_used[:, None], vertices, 0), "vertex", 125)
        self._recipe = Scene, (vertices, numbers), options
        super().__init__("faces", _arrays.triangles("faces", vertices[numbers]), _settings(**options))

    @classmethod
    @in_context
    def of_triangles(cls, corners: npt.ArrayLike, *, degenerate: Degenerate = "leave out", threads: int | None = None) -> Scene:
        """Returns a scene of grey triangles from their corners, of shape (N, 3, 3), float32 or float64. Triangles
        without area are as in Scene(). Raises InputError, which names the triangle that cannot be used."""
        scene = cls.__new__(cls)
        kept = np.array(_arrays.reals("triangles", corners), order="C")
        options = {"degenerate": degenerate, "threads": threads}
        scene._recipe = cls.of_triangles, (kept,), options
        super(Scene, scene).__init__("triangles", _arrays.triangles("triangles", kept), _settings(**options))
        return scene

    def __repr__(self) -> str:
        return f"<raygate.Scene: {self.triangle_count} triangles, {len(self.objects)} objects, {len(self.materials)} materials>"

    def __reduce__(self) -> tuple[Any, ...]:
        make, arguments, options = self._recipe
        return functools.partial(make, **options), arguments

    @in_context
    def trace(self, origins: npt.ArrayLike, directions: npt.ArrayLike, limits: npt.ArrayLike | None = None, *,
              hits: Literal["nearest", "any", "all"] = "nearest", columns: str | Iterable[str] | None = None,
              threads: int | None = None) -> Array:
        """Returns the hits of rays: a structured array with a field, int64 or float64, for each answer.

        origins, directions: shape (N, 3), or one vector for all rays, of shape (3,) or (1, 3); float64 in C order is read without a copy.
        Hits are at origin + t direction with 0 < t < limit, exactly, in float64. But origins are rounded to float64 relative to the scene's
        middle, unless all vertices are float32 numbers around 0: see rounded_rays. Directions have any length; (0, 0, 0) hits nothing.
        limits: shape (N,), or one number for all rays; none by default. threads: 1 to 1024, one per processor by default. hits:
        "nearest", a row for each ray; "any", a row for each ray that says whether it hits anything (faster); "all", a row for each hit of
        each ray, near before far, at equal t the lower triangle first. A ray exactly through an edge or a vertex counts as tilted by an
        infinitesimal angle towards +x, and by smaller ones towards +y and +z. So where it crosses a closed mesh it hits one triangle, where
        it touches a silhouette none or two, and of an open mesh's border one side. A triangle in a plane with the origin is never hit.

        columns: one name or several; by default all but material and side. "any" has only ray, hit and doubts, by default ray
        and hit. ray, triangle, object, material: numbers from 0. hit: 1 or 0. t: relative error at most 2^-33. point (fields x,
        y, z): in the scene's coordinates; errors at most 2^-33 |t direction|, plus rounding. uv (u, v): the point is (1 - u - v) A + u B +
        v C; error at most 2^-34. normal (nx, ny, nz): (B - A) x (C - A) divided by its length. side: the exact sign of direction . normal,
        -1 for the front, 1 for the back, 0 for a miss. doubts: tests of the ray that exact arithmetic decided. A miss has triangle, object
        and material -1, t inf and other float64 fields nan. The t of a hit is inf if it overflows: tell misses by `hit` or `triangle`.

        No rays, shape (0, 3), give no rows. Raises InputError for other shapes, masked elements and unknown names; for inf,
        NaN, limits that are not above 0 and origins farther than 2^126 from the scene it names the ray."""
        origins, directions = _arrays.rays(origins, directions)
        if limits is not None:
            limits = _arrays.reals("limits", limits)
            if limits.shape not in ((), (len(origins),)):
                raise InputError(f"limits: found an array of shape {limits.shape}, expected one number or shape ({len(origins)},)")
            limits = np.ascontiguousarray(np.broadcast_to(limits, len(origins)))
        if not isinstance(columns, (str, Iterable, type(None))):
            raise InputError(f"columns: found {columns!r}, expected a name or several names")
        names = [columns] if isinstance(columns, str) else [str(column) for column in columns or []]
        rows, fields = self._trace(origins, directions, limits, names, _settings(hits=hits, threads=threads))
        return rows.view(np.dtype(fields))

    @in_context
    def render(self, width: int | None = None, height: int | None = None, *, eye: npt.ArrayLike | None = None,
               target: npt.ArrayLike | None = None, up: npt.ArrayLike | None = None, **options: Unpack[RenderOptions]) -> Picture:
        """Returns a Picture: a dictionary of arrays of `height` rows (480), the top one first, and `width` columns (640), pixels.

        "color", shape (height, width, 4): scene-linear R, G, B, A, premultiplied. "normal", "point", "albedo", shape (height, width, 3);
        "depth", shape (height, width): float32. "triangle" and "object", shape (height, width): uint32, 4294967295 where nothing is hit.
        eye, target, up: three numbers each, in the file's coordinates; the camera of the scene file by default, or one that sees the
        whole scene. Other keywords are these options of ./render, with its defaults: spp, error, integrator, fov (degrees), depth, seed,
        filter, caustics, threshold, ambient, threads; there is no ground. Raises InputError, which names the option, for wrong values."""
        channels, film = self._render(_arrays.point("eye", eye), _arrays.point("target", target), _arrays.point("up", up),
                                      _settings(width=width, height=height, **options))
        return Picture(channels, film)

    @in_context
    def inside(self, points: npt.ArrayLike, *, threads: int | None = None) -> npt.NDArray[np.bool_]:
        """Returns whether points, of shape (N, 3), or (3,) for one, are inside closed surfaces: bool, (N,). threads: as for trace().

        A point is inside if a ray from it crosses surfaces an odd number of times. The count is exact for points rounded as origins are
        by trace(). So the orientation of faces does not matter, a shell within another one is a cavity, and the intersection of two solids
        is outside. If faces are oriented alike, winding_number(points)[0] != 0 is the union of solids. Answers have no meaning for an
        open surface (trimesh: is_watertight) or a point on one. Raises InputError, naming the point, for inf, NaN, numbers over 2^125."""
        points = _arrays.points(points, 125)
        hits = self.trace(points, _DIRECTION, hits="all", columns="ray", threads=threads)
        return np.asarray(np.bincount(hits["ray"], minlength=len(points)) % 2, np.bool_)

    @in_context
    def winding_number(self, points: npt.ArrayLike) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Returns how often the surfaces wind around points, of shape (N, 3) or (3,), and bounds of the errors: two arrays of float64,
        (N,). For a closed surface of faces oriented alike, even if it crosses itself, the number is whole and exact: 1 inside, 0 outside,
        2 where two solids overlap. For an open surface, the number is the surface's solid angle seen from the point over 4 pi. The error
        is inf if a point is so near a surface that rounding (see origins in trace()) may move the point across. The numbers have no
        meaning for a point on a surface. Raises InputError as inside() does."""
        points = _arrays.points(points, 125)
        hits = self.trace(points, _DIRECTION, hits="all", columns=["ray", "side"])
        crossings: Array = np.bincount(hits["ray"], hits["side"], minlength=len(points))
        rows = self._winding(points, crossings, _DIRECTION.tolist()).view(np.float64)
        return rows[0::2].copy(), rows[1::2].copy()

    @in_context
    def closest(self, points: npt.ArrayLike) -> Array:
        """Returns the nearest point of the surface to each point: a structured array of N rows with the fields triangle,
        int64, and distance, x, y and z, float64, in the scene's unit of length. points: shape (N, 3), or (3,) for one.

        Distances are computed in float64; of equal distances, the lowest triangle is returned. Coordinates are rounded relative to the
        scene's middle, so errors are absolute, and small distances have few digits. Raises InputError as inside() does, but beyond 2^1000."""
        points = _arrays.points(points, 1000)
        fields = [("triangle", "<i8"), *((name, "<f8") for name in ("distance", "x", "y", "z"))]
        return self._closest(points).view(np.dtype(fields))


def _settings(**options: object) -> list[tuple[str, str]]:
    """Returns the keywords that are not None as options of ./render: pairs of name and text."""
    return [(name, str(value)) for name, value in options.items() if value is not None]
