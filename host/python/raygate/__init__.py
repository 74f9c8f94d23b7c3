"""Rays in, exact hits and pictures out.

    import numpy, raygate
    scene = raygate.Scene("scenes/teapot.obj")
    hits = scene.trace(origins, directions)        # arrays of shape (N, 3)
    hits["triangle"], hits["t"]                    # -1 and inf where nothing is hit
    picture = scene.render(640, 480)["color"]      # (480, 640, 4), scene-linear

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

__all__ = ["InputError", "Scene", "float", "results"]


class Scene:
    """Triangles, materials, lights: an OBJ, glTF, PLY or STL file, or a scene file (JSON)."""

    @in_ieee_floats
    def __init__(self, file, *, strict=False, smooth=None, threads=None):
        """Reads `file` and builds its tree. InputError, a ValueError, says with file and line what
        cannot be used. `strict`: refuse faces without area. `smooth`: degrees at which faces
        without normals may meet to be smooth. `threads`: one per processor if None, here as
        everywhere."""
        name = os.fsencode(file)
        if b"\0" in name:
            raise InputError(f"file: found {file!r}, expected a name without a null byte")
        self._scene = _raygate.Scene(name, bool(strict), _settings(smooth=smooth, threads=threads))

    @classmethod
    @in_ieee_floats
    def of_triangles(cls, corners, *, threads=None):
        """A scene of grey triangles: corners of shape (N, 3, 3), float32 or float64. Triangles
        without area are refused: leave them out, no ray hits them."""
        corners = _numbers("triangles", corners)
        if corners.ndim != 3 or corners.shape[1:] != (3, 3) or not 0 < len(corners) < 2 ** 29:
            raise InputError(f"triangles: found an array of shape {corners.shape}, expected (N, 3, 3)")
        wrong = ~(np.abs(corners) <= 2.0 ** 125).all(axis=(1, 2))
        if wrong.any():
            raise InputError(f"triangles: found inf, nan or a coordinate beyond 2^125 in triangle "
                             f"{np.argmax(wrong)}, expected finite numbers")
        scene = cls.__new__(cls)
        scene._scene = _raygate.Scene(np.ascontiguousarray(corners).reshape(-1, 3),
                                      _settings(threads=threads))
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
    def origin(self):
        """The point that binary32 positions are relative to."""
        return np.array(self._scene.origin)

    @in_ieee_floats
    def trace(self, origins, directions, limits=None, *, hits="nearest", columns=None,
              engine="cpu", threads=None):
        """What rays hit: a structured array with a field for each answer.

        origins, directions: float32 or float64, shape (N, 3); read where they lie if they are in C
        order. Hits P = origin + t direction have 0 < t < limit; limits has shape (N,).
        hits: "nearest", a row for each ray; "any", whether there is a hit, sooner; "all", a row for
        each hit of each ray, near before far. columns: ray, hit, triangle, object, material, t,
        point (x, y, z), uv, normal (nx, ny, nz), doubts, unit-point, unit-error; what each means is
        in host/trace/README.md. engine: "cpu", or "model", the hit-test unit's reference model."""
        origins, directions = _vectors("origins", origins), _vectors("directions", directions)
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
        """A picture: a dictionary of arrays of `height` rows, the top one first.

        "color" (scene-linear R, G, B, A, premultiplied), "depth", "normal", "point", "albedo",
        "triangle" and "object" (4294967295 where nothing is hit). The camera is the scene file's,
        or sees the whole scene. Other keywords are options of ./render, with its defaults: spp,
        integrator, fov, depth, seed, filter, threshold, ambient, threads; and engine, "cpu" or
        "model"."""
        return self._scene.render(_point("eye", eye), _point("target", target), _point("up", up),
                                  _settings(width=width, height=height, **options))


def _settings(**options):
    """Keywords as the options of ./render: names and text, without those that are None."""
    return [(name, str(value)) for name, value in options.items() if value is not None]


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
