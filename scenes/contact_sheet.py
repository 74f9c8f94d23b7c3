#!/usr/bin/env python3
"""Renders models by their default view and puts the pictures on one sheet.

  make gallery MODELS=all                               # the models at hand: build/contact_sheet.png
  make gallery MODELS='bunny.ply room.glb'        # these
  make gallery MODELS=packages                          # 60 models of models.txt, from Debian's packages

The models at hand are those of scenes/ and build/scenes/, without their scene files; one of each format that this
script writes; and, if Debian's package assimp-testmodels is there, some of its models."""
import argparse
import gzip
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile

from PIL import Image, ImageDraw

import making
from make_sphere import icosphere

ROOT = pathlib.Path(__file__).resolve().parent.parent
ASSIMP = pathlib.Path("/usr/share/assimp/models")
ASSIMP_MODELS = ["OBJ/spider.obj", "OBJ/WusonOBJ.obj", "PLY/Wuson.ply", "PLY/cube_uv.ply", "STL/Spider_ascii.stl",
                 "STL/Spider_binary.stl", "STL/Wuson.stl", "STL/sphereWithHole.stl",
                 "glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb",
                 "glTF2/BoxTextured-glTF-Binary/BoxTextured.glb", "glTF2/textureTransform/TextureTransformTest.gltf",
                 "glTF2/ClearCoat-glTF/ClearCoatTest.gltf"]


def write_knot(folder: pathlib.Path) -> list[pathlib.Path]:
    """A trefoil knot's tube as PLY and STL, z upwards."""
    around, across = 200, 24
    points = []
    for i in range(around):
        a = 2 * math.pi * i / around
        centre = [math.sin(a) + 2 * math.sin(2 * a), math.cos(a) - 2 * math.cos(2 * a), -math.sin(3 * a)]
        ahead = [math.cos(a) + 4 * math.cos(2 * a), -math.sin(a) + 4 * math.sin(2 * a), -3 * math.cos(3 * a)]
        size = math.hypot(*ahead)
        ahead = [x / size for x in ahead]
        side = [ahead[1], -ahead[0], 0]
        size = math.hypot(*side)
        side = [x / size for x in side]
        top = [side[1] * ahead[2] - side[2] * ahead[1], side[2] * ahead[0] - side[0] * ahead[2],
               side[0] * ahead[1] - side[1] * ahead[0]]
        for k in range(across):
            b = 2 * math.pi * k / across
            points.append([c + 0.6 * (math.cos(b) * s + math.sin(b) * t) for c, s, t in zip(centre, side, top)])
    quads = [[i * across + k, i * across + (k + 1) % across, (i + 1) % around * across + (k + 1) % across,
              (i + 1) % around * across + k] for i in range(around) for k in range(across)]
    ply, stl = folder / "knot.ply", folder / "knot.stl"
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\n"
              f"property float y\nproperty float z\nelement face {len(quads)}\n"
              "property list uchar int vertex_indices\nend_header\n")
    ply.write_bytes(header.encode() + b"".join(struct.pack("<3f", *p) for p in points) +
                    b"".join(struct.pack("<B4i", 4, *quad) for quad in quads))
    facets = [(q[0], q[1], q[2]) for q in quads] + [(q[0], q[2], q[3]) for q in quads]
    stl.write_bytes(bytes(80) + struct.pack("<I", len(facets)) +
                    b"".join(bytes(12) + b"".join(struct.pack("<3f", *points[v]) for v in f) + bytes(2)
                             for f in facets))
    return [ply, stl]


def write_balls(file: pathlib.Path, smoothness: int = 4) -> pathlib.Path:
    """A GLB of ten balls: metal in the upper row, plastic in the lower one, rougher from left to right."""
    points, faces = icosphere(smoothness)
    positions = b"".join(struct.pack("<3f", *p) for p in points)
    indices = b"".join(struct.pack("<3I", *f) for f in faces)
    materials, nodes = [], []
    for row, (metallic, colour) in enumerate([(1, [1, 0.77, 0.34, 1]), (0, [0.1, 0.25, 0.7, 1])]):
        for column in range(5):
            materials.append({"pbrMetallicRoughness": {"baseColorFactor": colour, "metallicFactor": metallic,
                                                       "roughnessFactor": 0.05 + 0.2 * column}})
            nodes.append({"mesh": len(nodes), "translation": [2.4 * column, 2.4 * (1 - row), 0]})
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(10))}], "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}, "indices": 1, "material": i}]}
                   for i in range(10)],
        "materials": materials,
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3",
                       "min": [-1, -1, -1], "max": [1, 1, 1]},
                      {"bufferView": 1, "componentType": 5125, "count": 3 * len(faces), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(positions)},
                        {"buffer": 0, "byteOffset": len(positions), "byteLength": len(indices)}],
        "buffers": [{"byteLength": len(positions) + len(indices)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data = positions + indices
    file.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(data)) +
                     struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data)
    return file


def models_at_hand(folder: pathlib.Path) -> list[pathlib.Path]:
    stored = sorted((ROOT / "scenes").glob("*.obj")) + sorted((ROOT / "build" / "scenes").glob("*.obj"))
    return stored + write_knot(folder) + [write_balls(folder / "balls.glb")] + \
        [ASSIMP / name for name in ASSIMP_MODELS if (ASSIMP / name).is_file()]


def models_of_packages(folder: pathlib.Path) -> list[pathlib.Path]:
    """Those of models.txt. Packages are downloaded and unpacked into `folder`, not installed."""
    folder.mkdir(parents=True, exist_ok=True)
    models = []
    for line in (ROOT / "scenes" / "models.txt").read_text().splitlines():
        if line.startswith("#"):
            continue
        package, place, *names = line.split()
        unpacked = folder / package
        if not unpacked.exists():
            subprocess.run(["apt-get", "download", "-qq", package], cwd=folder, check=True)
            archive, = folder.glob(f"{package}_*.deb")
            subprocess.run(["dpkg-deb", "-x", archive, unpacked], check=True)
        for name in names:
            model = unpacked / place / name
            if model.suffix == ".gz":
                model.with_suffix("").write_bytes(gzip.decompress(model.read_bytes()))
                model = model.with_suffix("")
            models.append(model)
    return models


def render(program: pathlib.Path, model: pathlib.Path, size: tuple[int, int], options: list[str]) -> Image.Image:
    """Its picture, or what the program says."""
    with tempfile.TemporaryDirectory() as folder:
        picture = pathlib.Path(folder) / "picture.png"
        done = subprocess.run([program, model, "--no-scene-file", "--engine", "cpu", "--quiet", "--size",
                               f"{size[0]}x{size[1]}", "-o", picture, *options], capture_output=True, text=True)
        if done.returncode == 0:
            return Image.open(picture).convert("RGB").copy()
    tile = Image.new("RGB", size, "white")
    words = done.stderr.strip().splitlines()[-1:] or [f"exit status {done.returncode}"]
    ImageDraw.Draw(tile).multiline_text((8, size[1] // 3), "\n".join(
        words[0][i:i + 48] for i in range(0, len(words[0]), 48)), fill="black")
    return tile


def render_by_f3d(model: pathlib.Path, size: tuple[int, int]) -> Image.Image:
    """What f3d 1.3 shows without options; it needs a display, which xvfb-run gives."""
    with tempfile.TemporaryDirectory() as folder:
        picture = pathlib.Path(folder) / "picture.png"
        subprocess.run(["xvfb-run", "-a", "f3d", "--quiet", f"--resolution={size[0]},{size[1]}", f"--output={picture}",
                        model], capture_output=True, check=False, timeout=120)
        if picture.exists():
            return Image.open(picture).convert("RGB").copy()
    return Image.new("RGB", size, "white")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path, help="./render")
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("models", type=pathlib.Path, nargs="*", help="default: those at hand")
    parser.add_argument("--packages", action="store_true", help="those of models.txt instead")
    parser.add_argument("--f3d", action="store_true", help="f3d's picture beside each")
    parser.add_argument("--size", default="320x240", help="of each picture (320x240)")
    parser.add_argument("--columns", type=making.at_least(1), default=5)
    parser.add_argument("--options", default="", help="more of ./render")
    asked = parser.parse_args()
    size = tuple(int(side) for side in asked.size.split("x"))
    with tempfile.TemporaryDirectory() as folder:
        models = models_of_packages(ROOT / "build" / "models") if asked.packages else \
            asked.models or models_at_hand(pathlib.Path(folder))
        rows = math.ceil(len(models) / asked.columns)
        width = (2 if asked.f3d else 1) * size[0]
        sheet = Image.new("RGB", (asked.columns * width, rows * (size[1] + 16)), "white")
        for i, model in enumerate(models):
            place = (i % asked.columns * width, i // asked.columns * (size[1] + 16))
            sheet.paste(render(asked.program.resolve(), model.resolve(), size, asked.options.split()), place)
            if asked.f3d:
                sheet.paste(render_by_f3d(model, size), (place[0] + size[0], place[1]))
            ImageDraw.Draw(sheet).text((place[0] + 4, place[1] + size[1] + 2), model.name, fill="black")
            print(f"{i + 1} of {len(models)}: {model.name}", file=sys.stderr)
    sheet.save(asked.output)
    print(f"wrote {asked.output}: {len(models)} models")


if __name__ == "__main__":
    making.run(main)
