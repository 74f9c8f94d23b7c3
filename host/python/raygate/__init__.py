"""Rays in, exact hits and pictures out.

    import numpy, raygate
    scene = raygate.Scene("scenes/teapot.obj")
    hits = scene.trace(origins, directions)        # arrays of shape (N, 3)
    hits["triangle"], hits["t"]                    # -1 and inf where nothing is hit
    scene.closest(points)                          # points: shape (N, 3), or (3,) for one
    scene.inside(points)                           # of closed surfaces
    picture = scene.render(640, 480)               # a notebook shows it
    picture["color"]                               # (480, 640, 4), scene-linear
    picture.save("teapot.png")

Which triangles a ray hits, and in which order, is exact for float64 vertices and rays; help(Scene.trace) says when origins
are rounded. raygate.trimesh and raygate.open3d answer as the ray casters of these libraries do. raygate.float is IEEE 754 arithmetic in any small format.
"""

from . import _raygate, float, open3d, trimesh  # below, `float` is the module, not Python's class
from ._raygate import InputError
from ._scene import Picture, Scene

__all__ = ["InputError", "Picture", "Scene", "float", "open3d", "trimesh"]
__version__: str = _raygate.software.split()[-1]
