"""Queries of Open3D's open3d.t.geometry.RaycastingScene, with exact answers:

    scene = raygate.open3d.RaycastingScene()
    scene.add_triangles(vertices, triangles)       # or a mesh of Open3D
    scene.cast_rays([[0, 0, 5, 0, 0, -1]])["t_hit"]

It needs no Open3D to be installed. Arguments are arrays of NumPy, or anything that becomes one, in place of tensors, and so
are the answers. Where these differ from Open3D's: positions and rays are float64, and so are distances and points; a ray
through an edge or a vertex of a closed mesh hits it once, so that counts of intersections are right and one sample tells
inside from outside.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._raygate import InputError
from ._scene import Scene

Array = npt.NDArray[Any]


def _array(values: Any) -> Array:
    """Returns an array of float64 from an array or from a tensor of Open3D."""
    return np.asarray(values.numpy() if hasattr(values, "numpy") else values, np.float64)


def _rows(name: str, values: Any, width: int) -> tuple[tuple[int, ...], Array]:
    """Returns the shape of an array without its last axis, and its rows."""
    array = _array(values)
    if array.ndim == 0 or array.shape[-1] != width:
        raise InputError(f"{name}: found an array of shape {array.shape}, expected (..., {width})")
    return array.shape[:-1], array.reshape(-1, width)


class RaycastingScene:
    """Triangles, and queries of rays and points. Shapes are those of Open3D: (..., 6) for rays, (..., 3) for points, and the
    same leading axes for answers."""

    INVALID_ID = 4294967295

    def __init__(self, nthreads: int = 0) -> None:
        """`nthreads`: of each query; 0: one per processor."""
        self._threads = nthreads or None
        self._parts: list[Array] = []  # corners, (n, 3, 3), of each geometry
        self._scene: Scene | None = None

    def add_triangles(self, vertex_positions: Any, triangle_indices: Any = None) -> int:
        """Adds a mesh: vertices, shape (n, 3), and triangles, shape (m, 3), or an object of Open3D that has both. Returns
        its number, in "geometry_ids"."""
        if triangle_indices is None:
            mesh = vertex_positions
            vertex_positions, triangle_indices = mesh.vertex["positions"], mesh.triangle["indices"]
        vertices, triangles = _array(vertex_positions), _array(triangle_indices).astype(np.int64)
        self._parts.append(vertices[triangles])
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

    def _trace(self, rays: Any, hits: Any, columns: list[str], limits: Any = None) -> tuple[tuple[int, ...], Array]:
        shape, rows = _rows("rays", rays, 6)
        return shape, self._built.trace(rows[:, :3], rows[:, 3:], limits, hits=hits, columns=columns, threads=self._threads)

    def _names(self, triangles: Array, shape: tuple[int, ...]) -> dict[str, Array]:
        """Returns the numbers of geometries, and of triangles in them, in this shape."""
        parts = np.searchsorted(self._starts, triangles, "right") - 1
        is_hit = triangles >= 0
        numbers = {"geometry_ids": parts, "primitive_ids": triangles - self._starts[parts]}
        return {name: np.where(is_hit, number, self.INVALID_ID).astype(np.uint32).reshape(shape)
                for name, number in numbers.items()}

    def _normals(self, triangles: Array) -> Array:
        """Returns unit normals; 0 for -1."""
        a, b, c = np.moveaxis(self._corners[np.maximum(triangles, 0)], 1, 0)
        normals = np.cross(b - a, c - a)
        normals /= np.maximum(np.linalg.norm(normals, axis=-1, keepdims=True), 1e-300)
        return normals * (triangles >= 0)[:, None]

    def cast_rays(self, rays: Any, nthreads: int = 0) -> dict[str, Array]:
        """Returns the nearest hit of each ray: "t_hit" (infinite: none), "geometry_ids" and "primitive_ids" (INVALID_ID:
        none), "primitive_uvs" (0: none) and "primitive_normals" (0: none)."""
        shape, hits = self._trace(rays, "nearest", ["triangle", "t", "uv"])
        triangles = hits["triangle"]
        uvs = np.nan_to_num(np.stack([hits["u"], hits["v"]], -1))
        return {"t_hit": hits["t"].reshape(shape),
                **self._names(triangles, shape),
                "primitive_uvs": uvs.reshape(*shape, 2),
                "primitive_normals": self._normals(triangles).reshape(*shape, 3)}

    def test_occlusions(self, rays: Any, tnear: float = 0.0, tfar: float = np.inf, nthreads: int = 0) -> Array:
        """Returns whether each ray hits anything at tnear < t < tfar."""
        shape, rows = _rows("rays", rays, 6)
        if tnear > 0.0:  # hits up to tnear may be the nearest ones, so all are needed
            hits = self._built.trace(rows[:, :3], rows[:, 3:], tfar, hits="all", columns=["ray", "t"], threads=self._threads)
            return (np.bincount(hits["ray"][hits["t"] > tnear], minlength=len(rows)) > 0).reshape(shape)
        return self._trace(rays, "any", ["hit"], tfar)[1]["hit"].astype(bool).reshape(shape)

    def count_intersections(self, rays: Any, nthreads: int = 0) -> Array:
        """Returns the number of triangles that each ray hits."""
        shape, hits = self._trace(rays, "all", ["ray"])
        return np.bincount(hits["ray"], minlength=int(np.prod(shape))).astype(np.int32).reshape(shape)

    def list_intersections(self, rays: Any, nthreads: int = 0) -> dict[str, Array]:
        """Returns all hits, near before far: "ray_ids", "t_hit", "geometry_ids", "primitive_ids" and "primitive_uvs", and
        "ray_splits": hits of ray i are those from ray_splits[i] to ray_splits[i + 1]."""
        shape, hits = self._trace(rays, "all", ["ray", "triangle", "t", "uv"])
        counts = np.bincount(hits["ray"], minlength=int(np.prod(shape)))
        return {"ray_splits": np.concatenate([[0], np.cumsum(counts)]).astype(np.uint32),
                "ray_ids": hits["ray"].astype(np.uint32), "t_hit": hits["t"], **self._names(hits["triangle"], (-1,)),
                "primitive_uvs": np.stack([hits["u"], hits["v"]], -1)}

    def compute_closest_points(self, query_points: Any, nthreads: int = 0) -> dict[str, Array]:
        """Returns the nearest point of the surface to each point: "points", "geometry_ids", "primitive_ids", "primitive_uvs"
        and "primitive_normals"."""
        shape, points = _rows("query_points", query_points, 3)
        found = self._built.closest(points)
        at = np.stack([found["x"], found["y"], found["z"]], -1)
        a, b, c = np.moveaxis(self._corners[found["triangle"]], 1, 0)
        normals = np.cross(b - a, c - a)
        squares = np.maximum((normals * normals).sum(-1), 1e-300)
        uvs = np.stack([(np.cross(c - a, a - at) * normals).sum(-1), (np.cross(b - a, at - a) * normals).sum(-1)], -1)
        return {"points": at.reshape(*shape, 3),
                **self._names(found["triangle"], shape),
                "primitive_uvs": np.clip(uvs / squares[:, None], 0.0, 1.0).reshape(*shape, 2),
                "primitive_normals": self._normals(found["triangle"]).reshape(*shape, 3)}

    def compute_distance(self, query_points: Any, nthreads: int = 0) -> Array:
        """Returns the distance of each point from the surface."""
        shape, points = _rows("query_points", query_points, 3)
        return self._built.closest(points)["distance"].reshape(shape)

    def compute_occupancy(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> Array:
        """Returns 1 for points inside of the surface, which must be closed, and 0 for those outside. `nsamples` changes
        nothing: one ray tells."""
        shape, points = _rows("query_points", query_points, 3)
        return self._built.inside(points).astype(np.float32).reshape(shape)

    def compute_signed_distance(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> Array:
        """Returns the distance of each point from the surface, which must be closed; negative inside."""
        sign = 1.0 - 2.0 * self.compute_occupancy(query_points)
        distance: Array = sign * self.compute_distance(query_points)
        return distance
