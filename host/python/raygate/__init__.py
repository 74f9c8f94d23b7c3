"""Rays in, exact hits and pictures out.

    import numpy, raygate
    scene = raygate.Scene("scenes/teapot.obj")
    hits = scene.trace(origins, directions)        # arrays of shape (N, 3)
    hits["triangle"], hits["t"]                    # -1 and inf where nothing is hit
    scene.inside(points), scene.closest(points)    # of points of shape (N, 3)
    picture = scene.render(640, 480)               # a notebook shows it
    picture["color"]                               # (480, 640, 4), scene-linear
    picture.save("teapot.png")

Hits are exact: which triangle is nearest, and in which order several lie, is decided for the corners
and rays as binary32 holds them relative to the scene's middle (Scene.origin).

raygate.float is IEEE 754 arithmetic in any small format; raygate.results reads what this
repository's benchmarks and synthesis have measured.
"""

import os

import numpy as np

from . import _raygate
from . import float, results  # from here on `float` is the module, not Python's class
from ._arithmetic import in_ieee_floats
from ._raygate import InputError

__all__ = ["InputError", "Picture", "Scene", "float", "results"]
__version__ = _raygate.software.split()[-1]


class Picture(dict):
    """What Scene.render gives: arrays by name. A notebook shows it as a PNG."""

    def __init__(self, channels, film):
        super().__init__(channels)
        self._film = film

    def save(self, file, exposure=0.0):
        """Writes a PNG, `exposure` stops brighter, or an OpenEXR file, as the name ends."""
        ending = os.path.splitext(os.fsdecode(file))[1].lower()
        if ending not in (".png", ".exr"):
            raise InputError(f"save: found {os.fsdecode(file)!r}, expected a name that ends in .png or .exr")
        data = self._film.exr() if ending == ".exr" else self.png(exposure)
        with open(file, "wb") as output:
            output.write(data)

    def png(self, exposure=0.0):
        """The bytes of a PNG file."""
        return self._film.png(exposure)

    _repr_png_ = png


class Scene:
    """Triangles, materials, lights: an OBJ, glTF, PLY or STL file, a scene file (JSON), or arrays
    of vertices and faces."""

    @in_ieee_floats
    def __init__(self, file, faces=None, *, strict=False, smooth=None, threads=None):
        """Reads `file`, or takes vertices of shape (N, 3) and, as `faces`, the numbers of three
        vertices in each row, shape (M, 3); and builds its tree. InputError, a ValueError, says with
        file and line what cannot be used. `strict`: refuse faces without area, which are left out.
        `smooth`: degrees at which faces without normals may meet to be smooth. `threads`: one per
        processor if None, here as everywhere."""
        if faces is not None or not isinstance(file, (str, bytes, os.PathLike)):
            self._scene = _scene_of(_corners(file, faces), strict, smooth, threads)
            return
        name = os.fsencode(file)
        if b"\0" in name:
            raise InputError(f"file: found {file!r}, expected a name without a null byte")
        self._scene = _raygate.Scene(name, bool(strict), _settings(smooth=smooth, threads=threads))

    @classmethod
    @in_ieee_floats
    def of_triangles(cls, corners, *, threads=None):
        """A scene of grey triangles: corners of shape (N, 3, 3), float32 or float64. No ray hits
        triangles without area; they keep their numbers."""
        scene = cls.__new__(cls)
        scene._scene = _scene_of(corners, False, None, threads)
        return scene

    @property
    def triangle_count(self):
        return self._scene.triangle_count

    @property
    def objects(self):
        """Names of the file's `o` and `g`, which the field "object" of hits counts."""
        return self._scene.objects

    @property
    def materials(self):
        """Names of the materials, which the field "material" of hits counts."""
        return self._scene.materials

    @property
    def warnings(self):
        """What the file says that was not understood, a line each."""
        return self._scene.warnings

    @property
    def rounding(self):
        """How many corners binary32 does not hold as they were given, and the largest error of one
        of their coordinates."""
        return self._scene.rounding

    @property
    def origin(self):
        """The point that binary32 positions are relative to."""
        return np.array(self._scene.origin)

    @in_ieee_floats
    def trace(self, origins, directions, limits=None, *, hits="nearest", columns=None,
              engine="cpu", threads=None):
        """What rays hit: a structured array with a field for each answer.

        origins, directions: float32 or float64, shape (N, 3); read where they lie if they are in C
        order. One of them may be one vector, shape (3,), for all rays. Hits P = origin + t direction have 0 < t < limit; limits has shape (N,).
        hits: "nearest", a row for each ray; "any", whether there is a hit, sooner; "all", a row for
        each hit of each ray, near before far. columns: ray, hit, triangle, object, material, t,
        point (x, y, z), uv, normal (nx, ny, nz), side, doubts, unit-point, unit-error; what each means is
        in host/docs/reference.md. engine: "cpu", or "model", the hit-test unit's reference model."""
        origins, directions = _rays(origins, directions)
        if limits is not None:
            limits = np.ascontiguousarray(_numbers("limits", limits))
            if limits.shape != (len(origins),):
                raise InputError(f"limits: found an array of shape {limits.shape}, expected one "
                                 f"number for each ray, ({len(origins)},)")
        columns = [str(column) for column in columns or []]
        rows, fields = self._scene.trace(origins, directions, limits, columns,
                                         _settings(hits=hits, engine=engine, threads=threads))
        return rows.view(np.dtype([tuple(field) for field in fields]))

    @in_ieee_floats
    def render(self, width=None, height=None, *, eye=None, target=None, up=None, **options):
        """A Picture: a dictionary of arrays of `height` rows, the top one first.

        "color" (scene-linear R, G, B, A, premultiplied), "depth", "normal", "point", "albedo",
        "triangle" and "object" (4294967295 where nothing is hit). The camera is the scene file's,
        or sees the whole scene. Other keywords are options of ./render, with its defaults: spp,
        integrator, fov, depth, seed, filter, threshold, ambient, threads; and engine, "cpu" or
        "model"."""
        return Picture(*self._scene.render(_point("eye", eye), _point("target", target),
                                           _point("up", up),
                                           _settings(width=width, height=height, **options)))

    @in_ieee_floats
    def inside(self, points):
        """Whether points, shape (N, 3), are inside of closed surfaces: an array of bool. Exact: it
        counts how often a ray from the point leaves and enters surfaces. The answer has no meaning
        for an open surface and for a point on a surface."""
        points = _vectors("points", points)
        direction = np.float32([0.36, 0.48, 0.8])  # as good as any
        hits = self.trace(points, direction, hits="all", columns=["ray", "side"])
        return np.bincount(hits["ray"], hits["side"], minlength=len(points)) != 0

    @in_ieee_floats
    def closest(self, points):
        """The nearest points of the surface to points, shape (N, 3): a structured array with the
        fields triangle, distance, x, y and z, in double."""
        points = _vectors("points", points)
        wrong = ~(np.abs(points) <= 2.0 ** 100).all(axis=1)
        if wrong.any():
            raise InputError(f"points: found inf, nan or a coordinate beyond 2^100 in point "
                             f"{np.argmax(wrong)}, expected finite numbers")
        rows = np.empty(len(points), [("triangle", "<i8"), *((name, "<f8") for name in
                                                             ("distance", "x", "y", "z"))])
        numbers = self._scene.closest(points)
        for k, name in enumerate(rows.dtype.names):
            rows[name] = numbers[:, k]
        return rows


def _settings(**options):
    """Keywords as the options of ./render: names and text, without those that are None."""
    return [(name, str(value)) for name, value in options.items() if value is not None]


def _scene_of(corners, strict, smooth, threads):
    """The C++ half of a scene of triangles, from their corners."""
    corners = _numbers("triangles", corners)
    if corners.ndim != 3 or corners.shape[1:] != (3, 3) or not 0 < len(corners) < 2 ** 29:
        raise InputError(f"triangles: found an array of shape {corners.shape}, expected (N, 3, 3)")
    wrong = ~(np.abs(corners) <= 2.0 ** 125).all(axis=(1, 2))
    if wrong.any():
        raise InputError(f"triangles: found inf, nan or a coordinate beyond 2^125 in triangle "
                         f"{np.argmax(wrong)}, expected finite numbers")
    return _raygate.Scene(np.ascontiguousarray(corners).reshape(-1, 3), bool(strict),
                          _settings(smooth=smooth, threads=threads))


def _corners(vertices, faces):
    """Corners of triangles, shape (M, 3, 3)."""
    vertices = _vectors("vertices", vertices)
    if faces is None:
        raise InputError("faces: found None, expected the numbers of three vertices in each row")
    faces = np.asarray(faces)
    if faces.ndim != 2 or faces.shape[1] != 3 or faces.dtype.kind not in "iu" or not len(faces):
        raise InputError(f"faces: found an array of {faces.dtype} of shape {faces.shape}, expected "
                         "whole numbers of shape (M, 3)")
    wrong = ((faces < 0) | (faces >= len(vertices))).any(axis=1)
    if wrong.any():
        raise InputError(f"faces: found {faces[np.argmax(wrong)].tolist()} in face {np.argmax(wrong)}, "
                         f"expected numbers from 0 to {len(vertices) - 1}")
    return vertices[faces]


def _rays(origins, directions):
    """Origins and directions, as many of one as of the other."""
    origins, directions = _numbers("origins", origins), _numbers("directions", directions)
    if origins.ndim == 1 and directions.ndim == 2:
        origins = np.broadcast_to(origins, directions.shape) if origins.shape == (3,) else origins
    elif directions.ndim == 1 and origins.ndim == 2:
        directions = np.broadcast_to(directions, origins.shape) if directions.shape == (3,) else directions
    return _vectors("origins", origins), _vectors("directions", directions)


def _point(name, value):
    if value is None:
        return None
    point = _numbers(name, value)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise InputError(f"{name}: found {value!r}, expected three finite numbers")
    return point.tolist()


def _vectors(name, array):
    array = _numbers(name, array)
    if array.ndim != 2 or array.shape[1] != 3:
        raise InputError(f"{name}: found an array of shape {array.shape}, expected (N, 3)")
    return np.ascontiguousarray(array)


def _numbers(name, array):
    try:
        array = np.asarray(array)
    except ValueError:  # rows of several lengths
        array = np.asarray(None)
    if array.dtype.kind not in "fiu":
        raise InputError(f"{name}: found an array of {array.dtype}, expected numbers")
    if array.dtype not in (np.float32, np.float64):
        array = array.astype(np.float64)
    return array
