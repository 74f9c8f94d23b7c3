"""Tests that the camera written by blender_camera.py projects points like Blender's camera."""
import math
import pathlib
import random
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent))

from blender_camera import axes_of_file, camera_setting, vertical_fov


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def place_in_picture(setting, aspect, point):
    """Projects a point like raygate's camera. Returns x and y from -1 (left or lower edge) to 1."""
    way = [p - e for p, e in zip(point, setting["eye"])]
    forward = unit([t - e for t, e in zip(setting["target"], setting["eye"])])
    right = unit(cross(forward, setting["up"]))
    up = cross(right, forward)
    half = math.tan(math.radians(setting["fov"]) / 2)
    depth = dot(way, forward)
    return dot(way, right) / (depth * half * aspect), dot(way, up) / (depth * half)


def blender_place(world, lens, sensor, fit, size, point):
    """Projects a point like Blender's projection matrix (BKE_camera_params_compute_viewplane); returns x and y as place_in_picture does.
    The sensor spans one side of the picture, given by `fit`: the longer one (AUTO), the width (HORIZONTAL) or the height (VERTICAL)."""
    axes = [[row[column] for row in world[:3]] for column in range(4)]
    way = [p - e for p, e in zip(point, axes[3])]
    x, y, z = (dot(way, axis) for axis in axes[:3])
    if fit == "AUTO":
        side, pixels = sensor[0], max(size)
    else:
        side, pixels = (sensor[0], size[0]) if fit == "HORIZONTAL" else (sensor[1], size[1])
    step = side / pixels / lens  # a pixel at distance 1
    return x / -z / (step * size[0] / 2), y / -z / (step * size[1] / 2)


def rotation(random_numbers):
    """Returns the rows of a random rotation."""
    first = unit([random_numbers.gauss(0, 1) for _ in range(3)])
    second = unit(cross(first, [random_numbers.gauss(0, 1) for _ in range(3)]))
    return [list(row) for row in zip(first, second, cross(first, second))]


class BlenderCamera(unittest.TestCase):
    def test_blenders_own_default_camera(self):
        # 50 mm lens, 36 mm sensor, full HD: Blender displays 39.6 degrees horizontally, 22.9 vertically.
        self.assertAlmostEqual(vertical_fov(50, (36, 24), "AUTO", (1920, 1080)), 22.8952, places=4)
        self.assertAlmostEqual(vertical_fov(50, (36, 24), "VERTICAL", (1920, 1080)), 26.9915, places=4)

    def test_a_new_camera_looks_down(self):
        identity = [[float(i == k) for k in range(4)] for i in range(4)]
        self.assertEqual(camera_setting(identity, 30, "y"),
                         {"eye": [0, 0, 0], "target": [0, -1, 0], "up": [0, 0, -1], "fov": 30})
        self.assertEqual(camera_setting(identity, 30, "z"),
                         {"eye": [0, 0, 0], "target": [0, 0, -1], "up": [0, 1, 0], "fov": 30})

    def test_it_sees_what_blender_sees(self):
        numbers = random.Random(1)
        for _ in range(1000):
            turned = rotation(numbers)
            eye = [numbers.uniform(-9, 9) for _ in range(3)]
            world = [[*row, e] for row, e in zip(turned, eye)] + [[0, 0, 0, 1]]
            lens, sensor = numbers.uniform(10, 200), (numbers.uniform(10, 50), numbers.uniform(10, 50))
            fit, size = numbers.choice(["AUTO", "HORIZONTAL", "VERTICAL"]), (numbers.randint(1, 4000),
                                                                            numbers.randint(1, 4000))
            up = numbers.choice("yz")
            in_camera = [numbers.uniform(-1, 1), numbers.uniform(-1, 1), -numbers.uniform(0.5, 5)]
            point = [dot(row, in_camera) + e for row, e in zip(turned, eye)]
            setting = camera_setting(world, vertical_fov(lens, sensor, fit, size), up)
            found = place_in_picture(setting, size[0] / size[1], axes_of_file(point, up))
            for a, b in zip(found, blender_place(world, lens, sensor, fit, size, point)):
                self.assertLess(abs(a - b), 1e-9 * max(1, abs(b)))


if __name__ == "__main__":
    unittest.main()
