"""Rays in, exact hits and pictures out.

    import numpy, raygate
    scene = raygate.Scene("scenes/teapot.obj")
    hits = scene.trace(origins, directions)        # arrays of shape (N, 3)
    hits["triangle"], hits["t"]                    # -1 and inf where nothing is hit
    picture = scene.render(640, 480)["color"]      # (480, 640, 4), scene-linear

Hits are exact: which triangle is nearest, and in which order several lie, is decided for the corners
and rays as binary32 holds them relative to the scene's middle (Scene.origin).
"""

import os

import numpy as np

from . import _raygate
from ._raygate import InputError

__all__ = ["InputError", "Scene"]


class Scene:
    """Triangles, materials, lights: an OBJ file, or a scene file (JSON) about one."""

    def __init__(self, file, *, strict=False, threads=None):
        """Reads `file` and builds its tree. InputError, a ValueError, says with file and line what
        cannot be used. `strict`: refuse faces without area. `threads`: one per
        processor if None, here as everywhere."""
        self._scene = _raygate.Scene(os.fspath(file), strict, threads)

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

    def trace(self, origins, directions, limits=None, *, hits="nearest", columns=None,
              engine="cpu", threads=None):
        """What rays hit: a structured array with a field for each answer.

        origins, directions: float32 or float64, shape (N, 3); read where they lie if they are in C
        order. Hits P = origin + t direction have 0 < t < limit; limits has shape (N,).
        hits: "nearest", a row for each ray; "any", whether there is a hit, sooner; "all", a row for
        each hit of each ray, near before far. columns: ray, hit, triangle, object, material, t,
        point (x, y, z), uv, normal (nx, ny, nz), doubts, unit-point, unit-error; what each means is
        in host/README.md. engine: "cpu", or "model", the hit-test unit's reference model."""
        rows, fields = self._scene.trace(
            _vectors(origins), _vectors(directions), None if limits is None else _numbers(limits),
            hits, list(columns or []), engine, threads)
        return rows.view(np.dtype([tuple(field) for field in fields]))

    def render(self, width=640, height=480, *, spp=1, integrator="whitted", eye=None, target=None,
               up=None, fov=None, depth=None, seed=0, filter="blackman-harris", engine="cpu",
               threads=None):
        """A picture: a dictionary of arrays of `height` rows, the top one first.

        "color" (scene-linear R, G, B, A, premultiplied), "depth", "normal", "point", "albedo",
        "triangle" and "object" (4294967295 where nothing is hit). Options are those of ./render;
        the camera is the scene file's, or sees the whole scene."""
        return self._scene.render(width, height, spp, integrator, eye, target, up, fov, depth, seed,
                                  filter, engine, threads)


def _vectors(array):
    array = np.asarray(array)
    if array.ndim != 2 or array.shape[1] != 3:
        raise InputError(f"found an array of shape {array.shape}, expected (N, 3)")
    return _numbers(array)


def _numbers(array):
    array = np.asarray(array)
    if array.dtype not in (np.float32, np.float64):
        array = array.astype(np.float64)
    return np.ascontiguousarray(array)
