#!/usr/bin/env python3
"""Writes Blender's camera as a scene file, as OBJ, PLY or STL files from Blender cannot hold it.

  blender room.blend --background --python scenes/blender_camera.py -- room.obj

writes room.json beside room.obj. (A glTF file contains its camera, if Cameras was ticked.) --up z is for files exported with
Z Up, the default for PLY and STL. OBJ files have Y Up by default. scenes/CONVENTIONS.md lists the conversions."""
import argparse
import json
import math
import pathlib
import sys


def vertical_fov(lens: float, sensor: tuple[float, float], fit: str, size: tuple[float, float]) -> float:
    """Returns the vertical field of view in degrees. `lens`, `sensor`: focal length; sensor width and height, in the same unit.
    `fit`: Blender's Sensor Fit, AUTO (the sensor's width is the picture's longer side), HORIZONTAL or VERTICAL.
    `size`: width and height of the picture, times the pixel aspect."""
    width, height = size
    is_across = fit == "HORIZONTAL" or (fit == "AUTO" and width >= height)
    sensor_side = sensor[1] if fit == "VERTICAL" else sensor[0]
    tangent = sensor_side / (2 * lens)
    return math.degrees(2 * math.atan(tangent * height / width if is_across else tangent))


def axes_of_file(vector: tuple[float, float, float], up: str) -> list[float]:
    """Converts a vector from Blender's axes (z up) to the file's axes. `up`: "y" if exported with Y Up and -Z Forward, "z" if unchanged."""
    x, y, z = vector
    return [x, z, -y] if up == "y" else [x, y, z]


def camera_setting(world: list[list[float]], fov: float, up: str) -> dict:
    """Returns the value of key `camera` of a scene file. `world`: the rows of the matrix from camera to world coordinates. In camera
    coordinates, the camera looks along -z, and +y is upwards in the picture."""
    right, upwards, back, eye = ([row[column] for row in world[:3]] for column in range(4))
    del right
    length = math.sqrt(sum(x * x for x in back))
    target = [e - b / length for e, b in zip(eye, back)]
    return {"eye": axes_of_file(eye, up), "target": axes_of_file(target, up), "up": axes_of_file(upwards, up),
            "fov": fov}


def main(words: list[str]) -> None:
    import bpy  # only Blender's own Python has this module

    parser = argparse.ArgumentParser(prog="blender_camera.py", description=__doc__.splitlines()[0])
    parser.add_argument("scene", type=pathlib.Path, help="the exported file; the JSON is written beside it")
    parser.add_argument("--up", choices=["y", "z"], default="y", help="what is upwards in the exported file")
    asked = parser.parse_args(words)
    scene = bpy.context.scene
    if scene.camera is None:
        sys.exit("blender_camera.py: found no camera in the scene, expected an active one")
    camera, render = scene.camera.data, scene.render
    if camera.type != "PERSP" or camera.shift_x != 0 or camera.shift_y != 0:
        sys.exit(f"blender_camera.py: found a camera of type {camera.type} with shift {camera.shift_x}, "
                 f"{camera.shift_y}; expected PERSP without shift")
    width = render.resolution_x * render.resolution_percentage // 100
    height = render.resolution_y * render.resolution_percentage // 100
    fov = vertical_fov(camera.lens, (camera.sensor_width, camera.sensor_height), camera.sensor_fit,
                       (width * render.pixel_aspect_x, height * render.pixel_aspect_y))
    world = [list(row) for row in scene.camera.matrix_world]
    file = asked.scene.with_suffix(".json")
    file.write_text(json.dumps({"obj": asked.scene.name, "camera": camera_setting(world, fov, asked.up),
                                "render": {"size": f"{width}x{height}"}}, indent=2) + "\n")
    print(f"wrote {file}")


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
