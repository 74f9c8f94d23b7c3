"""glTF models as raygate and Mitsuba render them, side by side, under the same light and sky."""

import json
import math
import pathlib
import sys
import tempfile

import mitsuba
import numpy

mitsuba.set_variant("scalar_rgb")

from host.lab.peers.gltf_scene import mitsuba_meshes  # noqa: E402  (wants a variant)
from host.lab.peers.measure import shown  # noqa: E402
from host.lab.peers.renderers import light_of  # noqa: E402
from host.lab.report import plots  # noqa: E402
from host.lab.rows import ROOT  # noqa: E402
from host.lab.steps import render  # noqa: E402

sys.path.insert(0, str(ROOT / "scenes"))
from contact_sheet import ASSIMP, write_balls  # noqa: E402

PACKAGED = ["glTF2/BoxTextured-glTF-Binary/BoxTextured.glb", "glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb"]
SKY = 0.4
WIDTH, HEIGHT = 320, 240
FOV = 30.0


def scene_of(meshes: dict) -> tuple[dict, dict]:
    """Camera and light around the meshes: as a scene file has them."""
    boxes = [mitsuba.load_dict(mesh).bbox() for mesh in meshes.values()]
    low = numpy.min([numpy.array(box.min) for box in boxes], axis=0)
    high = numpy.max([numpy.array(box.max) for box in boxes], axis=0)
    middle, size = (low + high) / 2, float(numpy.linalg.norm(high - low))
    away = numpy.array([math.sin(0.55), 0.5, math.cos(0.55)])
    eye = middle + away / numpy.linalg.norm(away) * size * 0.5 / math.tan(math.radians(FOV / 2)) * 1.05
    corner = middle + numpy.array([-0.75, 1.0, -0.25]) * size
    camera = {"eye": eye.tolist(), "target": middle.tolist(), "up": [0, 1, 0], "fov": FOV}
    # Its front, by the right-hand rule of the edges, looks down: Mitsuba's shines there alone.
    light = {"corner": corner.tolist(), "edges": [[size, 0, 0], [0, 0, size]], "radiance": 3.0}
    return camera, light


def by_mitsuba(meshes: dict, camera: dict, light: dict, samples: int) -> numpy.ndarray:
    corner, (along, across) = numpy.array(light["corner"]), numpy.array(light["edges"])
    # The rectangle from (-1, -1) to (1, 1) looks along +z.
    matrix = numpy.eye(4)
    matrix[:3, 0], matrix[:3, 1] = along / 2, across / 2
    matrix[:3, 2] = numpy.cross(along, across) / numpy.linalg.norm(numpy.cross(along, across))
    matrix[:3, 3] = corner + (along + across) / 2
    transform = mitsuba.ScalarTransform4f
    scene = mitsuba.load_dict({
        "type": "scene", "integrator": {"type": "path", "max_depth": 66}, **meshes,
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": [SKY] * 3}},
        "lamp": {"type": "rectangle", "to_world": transform(matrix), "bsdf": {
            "type": "diffuse", "reflectance": {"type": "rgb", "value": 0.0}},
            "emitter": {"type": "area", "radiance": {"type": "rgb", "value": light["radiance"]}}},
        "camera": {"type": "perspective", "fov_axis": "y", "fov": FOV,
                   "to_world": transform().look_at(camera["eye"], camera["target"], camera["up"]),
                   "film": {"type": "hdrfilm", "width": WIDTH, "height": HEIGHT, "rfilter": {"type": "box"},
                            "pixel_format": "rgb"}}})
    return numpy.array(mitsuba.render(scene, spp=samples))


def by_raygate(program: pathlib.Path, model: pathlib.Path, camera: dict, light: dict, samples: int,
               folder: pathlib.Path) -> numpy.ndarray:
    scene, picture = folder / "scene.json", folder / "picture.exr"
    scene.write_text(json.dumps({"obj": str(model), "camera": camera, "area_lights": [light], "background": [SKY] * 3}))
    render([program, scene], "--integrator", "path", "--filter", "box", "--spp", str(samples), "--size", f"{WIDTH}x{HEIGHT}",
           picture=picture)
    return light_of(mitsuba.Bitmap(str(picture)))


def measure(program: pathlib.Path, samples: int) -> list[dict]:
    """A row for each of the models at hand, and a strip: ours, Mitsuba's, their difference."""
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for model in [write_balls(folder / "balls.glb"), *(ASSIMP / file for file in PACKAGED if (ASSIMP / file).is_file())]:
            meshes = mitsuba_meshes(model, folder)
            camera, light = scene_of(meshes)
            ours = by_raygate(program, model.resolve(), camera, light, samples, folder)
            theirs = by_mitsuba(meshes, camera, light, samples)
            strip = numpy.concatenate([shown(ours), shown(theirs), numpy.clip(0.5 + ours - theirs, 0, 1)], axis=1)
            picture = pathlib.Path("build/peers") / f"{model.stem}.png"
            (ROOT / picture).parent.mkdir(parents=True, exist_ok=True)
            plots.save_pixels(strip, ROOT / picture)
            rows.append({"table": "gltf", "model": model.name, "mean_raygate": float(ours.mean()),
                         "mean_mitsuba": float(theirs.mean()), "mean_difference": float(abs(ours - theirs).mean()),
                         "picture": str(picture)})
    return rows
