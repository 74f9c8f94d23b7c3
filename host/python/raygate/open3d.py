"""Queries of Open3D's open3d.t.geometry.RaycastingScene, with exact answers:

    scene = raygate.open3d.RaycastingScene()
    scene.add_triangles(vertices, triangles)       # or a mesh of Open3D
    scene.cast_rays([[0, 0, 5, 0, 0, -1]])["t_hit"]

Open3D need not be installed. Arguments and answers are NumPy arrays, or what NumPy makes an array of, instead of tensors. Differences
from Open3D: positions, rays, distances and points are float64. Where a ray crosses a closed mesh at an edge or a vertex it hits it once
(see Scene.trace), so counts of crossings are right, and one sample tells inside from outside. Invalid arguments raise InputError.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _arrays
from ._arrays import Array
from ._raygate import InputError
from ._scene import Scene


def _array(values: Any) -> Any:
    """Returns a tensor of Open3D as an array, and anything else as it is."""
    return values.numpy() if hasattr(values, "numpy") else values


def _rows(name: str, values: Any, width: int) -> tuple[tuple[int, ...], Array]:
    """Returns the shape of an array without its last axis, and its rows."""
    array = _arrays.reals(name, _array(values))
    if array.ndim < 2 or array.shape[-1] != width:
        raise InputError(f"{name}: found an array of shape {array.shape}, expected (..., N, {width})")
    return array.shape[:-1], array.reshape(-1, width)


def _threads(nthreads: int) -> int | None:
    if not isinstance(nthreads, (int, np.integer)) or not 0 <= nthreads <= 1024:
        raise InputError(f"nthreads: found {nthreads!r}, expected a whole number from 0 to 1024")
    return int(nthreads) or None


class RaycastingScene:
    """Triangles, and queries of rays and points. Shapes are those of Open3D: (..., N, 6) for rays, (..., N, 3) for points, and
    the same leading axes for answers. `nthreads` of a query: 0 is one per processor; distances and closest points take one."""

    INVALID_ID = 4294967295

    def __init__(self, nthreads: int = 0) -> None:
        """`nthreads`: number of threads that build the scene, up to 1024; 0 is one per processor."""
        self._threads = _threads(nthreads)
        self._parts: list[Array] = []  # corners, (n, 3, 3), of each geometry
        self._scene: Scene | None = None

    def add_triangles(self, vertex_positions: Any, triangle_indices: Any = None) -> int:
        """Adds a mesh: vertices, shape (n, 3), and triangles, shape (m, 3), or an object of Open3D that has both. Returns
        its number, in "geometry_ids"."""
        if triangle_indices is None:
            mesh = vertex_positions
            vertex_positions, triangle_indices = mesh.vertex["positions"], mesh.triangle["indices"]
        vertices = _arrays.vectors("vertex_positions", _array(vertex_positions)).astype(np.float64)
        _arrays.check_finite("vertex_positions", vertices, "vertex", 125)
        self._parts.append(vertices[_arrays.vertex_numbers(_array(triangle_indices), len(vertices), "triangle_indices")])
        self._scene = None
        return len(self._parts) - 1

    @property
    def _built(self) -> Scene:
        if not self._parts:
            raise InputError("found a scene without triangles, expected a call of add_triangles")
        if self._scene is None:
            self._corners = np.concatenate(self._parts)
            self._starts = np.cumsum([0] + [len(part) for part in self._parts])
            self._scene = Scene.of_triangles(self._corners, threads=self._threads)
        return self._scene

    def _trace(self, rays: Any, nthreads: int, hits: Any, columns: list[str],
               limits: float | None = None) -> tuple[tuple[int, ...], Array]:
        shape, rows = _rows("rays", rays, 6)
        return shape, self._built.trace(rows[:, :3], rows[:, 3:], limits, hits=hits, columns=columns, threads=_threads(nthreads))

    def _names(self, triangles: Array, shape: tuple[int, ...]) -> dict[str, Array]:
        """Returns "geometry_ids" and "primitive_ids" of triangle numbers, in this shape: INVALID_ID for the number -1."""
        parts = np.searchsorted(self._starts, triangles, "right") - 1
        is_hit = triangles >= 0
        numbers = {"geometry_ids": parts, "primitive_ids": triangles - self._starts[parts]}
        return {name: np.where(is_hit, number, self.INVALID_ID).astype(np.uint32).reshape(shape) for name, number in numbers.items()}

    def _normals(self, triangles: Array) -> Array:
        """Returns unit normals of triangles by number; 0 for the number -1."""
        a, b, c = np.moveaxis(self._corners[np.maximum(triangles, 0)], 1, 0)
        normals = np.cross(b - a, c - a)
        normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-300)
        return normals * (triangles >= 0)[:, None]

    def cast_rays(self, rays: Any, nthreads: int = 0) -> dict[str, Array]:
        """Returns the nearest hit of each ray: "t_hit" (infinity: none), "geometry_ids" and "primitive_ids" (INVALID_ID: none),
        "primitive_uvs" (0: none) and "primitive_normals" (0: none)."""
        shape, hits = self._trace(rays, nthreads, "nearest", ["triangle", "t", "uv"])
        triangles = hits["triangle"]
        uvs = np.nan_to_num(np.stack([hits["u"], hits["v"]], -1))
        return {"t_hit": hits["t"].reshape(shape), **self._names(triangles, shape), "primitive_uvs": uvs.reshape(*shape, 2),
                "primitive_normals": self._normals(triangles).reshape(*shape, 3)}

    def test_occlusions(self, rays: Any, tnear: float = 0.0, tfar: float = np.inf, nthreads: int = 0) -> Array:
        """Returns whether each ray hits anything at tnear < t < tfar."""
        if not tfar > max(tnear, 0.0):
            return np.zeros(_rows("rays", rays, 6)[0], bool)
        if tnear > 0.0:  # hits up to tnear may be the nearest ones, so all are needed
            shape, hits = self._trace(rays, nthreads, "all", ["ray", "t"], tfar)
            return (np.bincount(hits["ray"][hits["t"] > tnear], minlength=int(np.prod(shape))) > 0).reshape(shape)
        shape, hits = self._trace(rays, nthreads, "any", ["hit"], tfar)
        return hits["hit"].astype(bool).reshape(shape)

    def count_intersections(self, rays: Any, nthreads: int = 0) -> Array:
        """Returns the number of triangles that each ray hits."""
        shape, hits = self._trace(rays, nthreads, "all", ["ray"])
        return np.bincount(hits["ray"], minlength=int(np.prod(shape))).astype(np.int32).reshape(shape)

    def list_intersections(self, rays: Any, nthreads: int = 0) -> dict[str, Array]:
        """Returns all hits, near before far: "ray_ids", "t_hit", "geometry_ids", "primitive_ids" and "primitive_uvs", and
        "ray_splits": hits of ray i are those from ray_splits[i] to ray_splits[i + 1]."""
        shape, hits = self._trace(rays, nthreads, "all", ["ray", "triangle", "t", "uv"])
        counts = np.bincount(hits["ray"], minlength=int(np.prod(shape)))
        return {"ray_splits": np.concatenate([[0], np.cumsum(counts)]).astype(np.uint32),
                "ray_ids": hits["ray"].astype(np.uint32), "t_hit": hits["t"], **self._names(hits["triangle"], (-1,)),
                "primitive_uvs": np.stack([hits["u"], hits["v"]], -1)}

    def _closest(self, query_points: Any, nthreads: int) -> tuple[tuple[int, ...], Array]:
        _threads(nthreads)
        shape, points = _rows("query_points", query_points, 3)
        return shape, self._built.closest(points)

    def compute_closest_points(self, query_points: Any, nthreads: int = 0) -> dict[str, Array]:
        """Returns the nearest point of the surface to each point: "points", "geometry_ids", "primitive_ids", "primitive_uvs"
        and "primitive_normals"."""
        shape, found = self._closest(query_points, nthreads)
        at = np.stack([found["x"], found["y"], found["z"]], -1)
        a, b, c = np.moveaxis(self._corners[found["triangle"]], 1, 0)
        normals = np.cross(b - a, c - a)
        squares = np.maximum((normals * normals).sum(-1), 1e-300)
        uvs = np.stack([(np.cross(c - a, a - at) * normals).sum(-1), (np.cross(b - a, at - a) * normals).sum(-1)], -1)
        return {"points": at.reshape(*shape, 3), **self._names(found["triangle"], shape),
                "primitive_uvs": np.clip(uvs / squares[:, None], 0.0, 1.0).reshape(*shape, 2),
                "primitive_normals": self._normals(found["triangle"]).reshape(*shape, 3)}

    def compute_distance(self, query_points: Any, nthreads: int = 0) -> Array:
        """Returns the distance of each point from the surface."""
        shape, found = self._closest(query_points, nthreads)
        return found["distance"].reshape(shape)

    def compute_occupancy(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> Array:
        """Returns 1 for points inside the surface, as Scene.inside() does, and 0 for others. `nsamples` must be odd, as in Open3D, but
        has no effect: one ray suffices."""
        if nsamples < 1 or nsamples % 2 != 1:
            raise InputError(f"nsamples: found {nsamples!r}, expected an odd number of at least 1")
        shape, points = _rows("query_points", query_points, 3)
        return self._built.inside(points, threads=_threads(nthreads)).astype(np.float32).reshape(shape)

    def compute_signed_distance(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> Array:
        """Returns the distance of each point from the surface, which must be closed; negative inside."""
        sign = 1.0 - 2.0 * self.compute_occupancy(query_points, nthreads, nsamples)
        return np.asarray(sign * self.compute_distance(query_points))
