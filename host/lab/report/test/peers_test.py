"""Tests the conversion of a small room for Mitsuba (faces, materials, lamps), and rows that compare both renderers."""

import json
import pathlib
import tempfile
import unittest

import numpy

from host.lab.peers import convert, measure
from host.lab.rows import of
from host.lab.targets import peers

OBJ = """\
mtllib room.mtl
v 0 0 0
v 1 0 0
v 1 0 1
v 0 0 1
vn 0 1 0
o floor
usemtl matte
f 1//1 2//1 3//1 4//1
v 0 1 0
v 1 1 0
v 1 1 1
o lamp
usemtl lamp
f -3 -2 -1
"""
MTL = """\
newmtl matte
Kd 0.5 0.25 0.125
illum 1
newmtl lamp
Kd 0 0 0
Ke 3 2 1
illum 1
"""
JSON = {"obj": "room.obj", "camera": {"eye": [0.5, 0.5, 3], "target": [0.5, 0.5, 0]}, "background": 0.25,
        "area_lights": [{"corner": [0, 0.5, 0], "edges": [[1, 0, 0], [0, 0, 1]], "radiance": [4, 5, 6]}]}


def made(folder: pathlib.Path, mtl: str = MTL, **more: object) -> convert.Scene:
    """Writes the room's files and returns the scene read from them."""
    (folder / "room.obj").write_text(OBJ)
    (folder / "room.mtl").write_text(mtl)
    (folder / "room.json").write_text(json.dumps(JSON | more))
    return convert.read(folder / "room.json")


class Peers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def converted(self, **more):
        convert.write_mitsuba(made(self.folder, **more), 8, self.folder)
        return json.loads((self.folder / "mitsuba.json").read_text())

    def test_faces_become_fans_of_welded_corners(self):
        floor, lamp = made(self.folder).meshes
        self.assertEqual((floor.material.name, len(floor.positions), len(floor.faces)), ("matte", 4, 2))
        self.assertEqual(floor.positions[floor.faces].tolist(), [[[0, 0, 0], [1, 0, 0], [1, 0, 1]], [[0, 0, 0], [1, 0, 1], [0, 0, 1]]])
        self.assertEqual(floor.normals.tolist(), [[0, 1, 0]] * 4)
        self.assertEqual(lamp.positions[lamp.faces[0]].tolist(), [[0, 1, 0], [1, 1, 0], [1, 1, 1]])
        self.assertIsNone(lamp.normals)

    def test_materials_are_those_of_both(self):
        def read(*statements):
            return convert.material("m", {line.split()[0]: line.split()[1:] for line in statements})

        self.assertEqual(read("Kd 0", "Ks 0.9", "illum 3").mirror, (0.9,) * 3)
        glass = read("Kd 0", "Tf 0.5 1 1", "Ni 1.5", "d 0.5", "illum 7")
        self.assertEqual((glass.transmittance, glass.index), ((0.25, 0.5, 0.5), 1.5))
        for statements in (["illum 0"], ["illum 4"], ["illum 1", "d 0.5"], ["Kd 0.5", "illum 7"], ["Ks 0.1", "illum 2"],
                           ["Kd 0.5", "Ks 0.5", "illum 3"], ["illum 1", "map_Kd a.png"]):
            with self.assertRaisesRegex(ValueError, "m: illum . with d .*: Mitsuba has no such material"):
                read(*statements)

    def test_mitsuba_gets_the_same_light_and_rules(self):
        found = self.converted()
        self.assertEqual(found["integrator"], {"type": "path", "rr_depth": 4, "max_depth": 66})
        self.assertEqual(found["background"]["radiance"]["value"], [0.25] * 3)

    def test_the_scenes_can_be_read(self):
        for name in measure.SCENES:
            file = measure.scene_file(name)
            if (file.parent / json.loads(file.read_text()).get("obj", file.with_suffix(".obj"))).exists():  # not made, not installed
                self.assertTrue(convert.read(measure.scene_file(name)).meshes)

    def test_lamps_face_what_they_light(self):
        found = self.converted()
        lamps = [part for part in found.values() if isinstance(part, dict) and "emitter" in part]
        # The OBJ file's lamp has everything below it; the scene file's lamp has surfaces on both sides, so it becomes two lamps.
        self.assertEqual([lamp["emitter"]["radiance"]["value"] for lamp in lamps], [[3, 2, 1], [4, 5, 6], [4, 5, 6]])
        heights = []
        for lamp in lamps:
            data = (self.folder / lamp["filename"]).read_bytes()
            head, body = data.split(b"end_header\n")
            count = int(head.split(b"element vertex ")[1].split()[0])
            corners = numpy.frombuffer(body[:12 * count], "<f4").reshape(-1, 3)
            face = numpy.frombuffer(body[12 * count:12 * count + 13], [("n", "u1"), ("at", "<i4", 3)])["at"][0]
            a, b, c = corners[face].astype(float)
            heights.append((round(float(a[1]), 3), float(numpy.sign(numpy.cross(b - a, c - a)[1]))))
        self.assertEqual(heights[0], (1.0, -1.0))
        self.assertEqual(sorted(heights[1:]), [(0.5, -1.0), (0.5, 1.0)])

    def test_the_summary_takes_mitsuba_at_its_best(self):
        def row(renderer, sampler, error, **more):
            return {"table": "peers", "scene": "room", "threads": 1, "renderer": renderer, "sampler": sampler,
                    "samples": 32, "median_seconds": 2.0, "mse": error, "mse_error": error / 10.0,
                    "display_mse": 81.0, "display_mse_error": 0.0} | more

        rows = [{"table": "references", "scene": "room"}, row("raygate", "sobol", 3.0), row("raygate", measure.NO_LIGHT_PATHS, 6.0),
                row("raygate", "sobol", 1.0, samples=8), row("raygate", "sobol", 9.0, threads=2),
                row("Mitsuba", "independent", 8.0), row("Mitsuba", "multijitter", 4.0, median_seconds=1.0)]
        rows += [row("raygate", sampler, 2.0, samples=16, median_seconds=1.1, equal_time=True) for sampler in ("sobol", measure.NO_LIGHT_PATHS)]
        (found,) = peers.summary(rows)
        self.assertEqual((found["seconds"], found["mse"], found["equal_mse"], found["plain_mse"], found["equal_display_mse"]),
                         (2.0, "0.75 ± 0.11", "0.50 ± 0.07", "0.50 ± 0.07", "1.00 ± 0.00"))
        self.assertAlmostEqual(found["off"], 0.1)
        with tempfile.TemporaryDirectory() as folder:
            plot = peers.error_against_time(of(rows, "peers"), "room", pathlib.Path(folder) / "room.png")
            self.assertTrue(plot.exists())

    def test_closed_lamps_shine_outwards_alone(self):
        corners = numpy.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
        faces = numpy.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        everything = numpy.concatenate([corners, corners + 9, corners - 9])
        material = convert.Material("lamp", emission=(1.0, 1.0, 1.0))
        whole = convert.Mesh(material, corners, None, faces)
        self.assertEqual(convert.light_meshes(whole, everything), [whole])
        sheet = convert.Mesh(material, corners, None, faces[:3])
        self.assertEqual(len(convert.light_meshes(sheet, everything)), 2)

    def test_errors_are_in_steps_of_a_display(self):
        black = numpy.zeros((2, 2, 3))
        self.assertAlmostEqual(measure.display_mse(black + 9.0, black), 255.0 ** 2)
        self.assertAlmostEqual(measure.display_mse(black + 0.214041, black) ** 0.5, 127.5, delta=1e-3)
        self.assertEqual(measure.display_mse(black + 2.0, black + 3.0), 0.0)

    def test_noise_of_a_reference(self):
        class Coin:
            def render(self, sampler, samples, seed):
                return {}, numpy.random.default_rng(seed).normal(1.0, 1.0, (200, 200, 3))

        mean, noise = measure.reference(Coin(), "", 1)
        self.assertAlmostEqual(measure.mse(mean, numpy.ones_like(mean)), noise, delta=0.02)
        self.assertAlmostEqual(noise, 0.5, delta=0.02)
