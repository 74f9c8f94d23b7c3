"""Rays in, exact hits and pictures out.

    import numpy, raygate
    scene = raygate.Scene("scenes/teapot.obj")
    hits = scene.trace(origins, directions)        # arrays of shape (N, 3)
    hits["triangle"], hits["t"]                    # -1 and inf where nothing is hit
    scene.inside(points), scene.closest(points)    # points: an array of shape (N, 3)
    picture = scene.render(640, 480)               # a notebook shows it
    picture["color"]                               # (480, 640, 4), scene-linear
    picture.save("teapot.png")

Hits are exact: binary32 holds the corners and rays relative to the scene's middle (Scene.origin), and for these numbers
the nearest triangle and the order of several triangles are always the right ones.

raygate.float is IEEE 754 arithmetic in any small format.
"""

from . import _raygate, float, trimesh  # from here on `float` is the module, not Python's class
from ._raygate import InputError
from ._scene import Picture, Scene

__all__ = ["InputError", "Picture", "Scene", "float", "trimesh"]
__version__: str = _raygate.software.split()[-1]
