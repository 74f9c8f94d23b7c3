"""A ray intersector for trimesh's meshes, with exact answers:

    mesh.ray = raygate.trimesh.RayMeshIntersector(mesh)

It has the methods of trimesh.ray.ray_pyembree.RayMeshIntersector and does not need trimesh. Its answers differ in these points: a ray
that crosses a closed mesh at an edge or a vertex hits it once, not once for each triangle there; all hits of a ray are found, however
near each other they are; a point on the surface may count as inside or outside. mesh.copy() has trimesh's own intersector again.
mesh.nearest stays trimesh's; mesh.ray.scene.closest() is raygate's.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from ._arrays import Array
from ._raygate import InputError
from ._scene import Scene


class RayMeshIntersector:
    """Rays and points against a mesh: an object with `vertices`, shape (n, 3), and `faces`, shape (m, 3). When these change,
    the next query builds the scene again. Arguments and errors of queries: Scene.trace() and Scene.inside()."""

    def __init__(self, geometry: Any, scale_to_box: bool = True) -> None:
        """`scale_to_box` has no effect; trimesh's own intersectors take it. Queries raise InputError for no mesh."""
        self.mesh = geometry
        self._built: tuple[Any, Scene] | None = None

    @property
    def scene(self) -> Scene:
        """The mesh as a raygate.Scene."""
        if not (hasattr(self.mesh, "vertices") and hasattr(self.mesh, "faces")):
            raise InputError(f"geometry: found a value of type {type(self.mesh).__name__}, expected a mesh")
        vertices, faces = np.asarray(self.mesh.vertices, np.float64), np.asarray(self.mesh.faces, np.int64)
        state = hash((vertices.tobytes(), faces.tobytes()))
        if self._built is None or self._built[0] != state:
            self._built = state, Scene(vertices, faces)
        return self._built[1]

    def intersects_id(self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike, multiple_hits: bool = True,
                      max_hits: int | None = None, return_locations: bool = False) -> tuple[Array, ...]:
        """Returns the triangles that rays hit, shape (k,), the numbers of their rays, shape (k,), and with `return_locations` the points,
        shape (k, 3). Returns all hits of each ray, near before far and at most `max_hits`; without `multiple_hits`, the nearest hit."""
        columns = ["ray", "triangle", "point"]
        hits = self.scene.trace(ray_origins, ray_directions, hits="all" if multiple_hits else "nearest", columns=columns)
        hits = hits[hits["triangle"] >= 0]
        if max_hits is not None and multiple_hits:
            first = np.searchsorted(hits["ray"], hits["ray"])  # hits are sorted by ray
            hits = hits[np.arange(len(hits)) - first < max_hits]
        triangles, rays = hits["triangle"].astype(np.int64), hits["ray"].astype(np.int64)
        locations = [np.stack([hits[axis] for axis in "xyz"], axis=-1)] if return_locations else []
        return triangles, rays, *locations

    def intersects_location(self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike,
                            multiple_hits: bool = True) -> tuple[Array, Array, Array]:
        """Returns the points, shape (k, 3), the numbers of the rays and the triangles of intersects_id()."""
        triangles, rays, points = self.intersects_id(ray_origins, ray_directions, multiple_hits, return_locations=True)
        return points, rays, triangles

    def intersects_first(self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike) -> Array:
        """Returns the first triangle that each ray hits, or -1: shape (n,)."""
        return self.scene.trace(ray_origins, ray_directions, columns="triangle")["triangle"].astype(np.int64)

    def intersects_any(self, ray_origins: npt.ArrayLike, ray_directions: npt.ArrayLike) -> Array:
        """Returns whether each ray hits anything: shape (n,)."""
        return np.asarray(self.scene.trace(ray_origins, ray_directions, hits="any", columns="hit")["hit"], bool)

    def contains_points(self, points: npt.ArrayLike) -> Array:
        """Returns whether points are inside of the mesh, which must be closed: shape (n,). As in trimesh, a closed shell
        within another one is a cavity, and the orientation of faces does not matter."""
        return self.scene.inside(points)
