"""A scene that both renderers support, read from the same OBJ, MTL and JSON files.

Materials are matte, perfect mirrors, and clear refractive glass. Two kinds are simplified for both renderers, as
reported in `Scene.left_out`. A glossy highlight (illum 2) becomes matte: Mitsuba has no Phong lobe. Of a mirror and a
matte lobe the stronger one is kept: Mitsuba 3.9's blendbsdf gives the mirror a fraction other than its weight (0.26
for 0.375 in a white furnace). Other unsupported features raise ValueError.
"""

import dataclasses
import json
import pathlib
import re

import numpy

Colour = tuple[float, float, float]


@dataclasses.dataclass
class Material:
    """The MTL statements that are used."""

    name: str
    diffuse: Colour = (0.8, 0.8, 0.8)
    mirror: Colour = (0.0, 0.0, 0.0)
    emission: Colour = (0.0, 0.0, 0.0)
    transmittance: Colour = (1.0, 1.0, 1.0)  # of glass
    index: float = 1.0
    is_glass: bool = False
    texture: pathlib.Path | None = None
    texture_scale: tuple[float, float] = (1.0, 1.0)


@dataclasses.dataclass
class Mesh:
    """All triangles of one material (and of one object, if they emit light)."""

    material: Material
    positions: numpy.ndarray  # n x 3
    normals: numpy.ndarray | None  # n x 3; None: flat
    texcoords: numpy.ndarray | None  # n x 2, v upwards
    faces: numpy.ndarray  # m x 3


@dataclasses.dataclass
class Scene:
    """A scene in the file's coordinates."""

    camera: dict  # eye, target, up, fov (vertical, in degrees)
    meshes: list[Mesh]
    point_lights: list[dict]  # position, intensity
    area_lights: list[dict]  # corner, edges, radiance
    background: Colour
    left_out: list[str]  # descriptions of simplifications, one sentence each
    obj: pathlib.Path
    mtl: pathlib.Path


def colour(value: object) -> Colour:
    """Returns a colour; one number stands for three."""
    values = [float(word) for word in (value if isinstance(value, list) else [value])]
    return tuple(values * 3 if len(values) == 1 else values)


def read_materials(file: pathlib.Path, left_out: list[str]) -> dict[str, Material]:
    """Returns the materials of an MTL file, by name."""
    statements: dict[str, dict[str, list[str]]] = {}
    for line in file.read_text().splitlines():
        word, *rest = line.split("#")[0].split() or [""]
        if word == "newmtl":
            mine = statements.setdefault(" ".join(rest), {})
        elif word:
            mine[word] = rest
    return {name: material(name, file.parent, found, left_out) for name, found in statements.items()}


def material(name: str, folder: pathlib.Path, found: dict[str, list[str]], left_out: list[str]) -> Material:
    """Returns one material from its statements."""
    made = Material(name)
    model = int(found.get("illum", ["2"])[0])
    opacity = float(found.get("d", ["1"])[0])
    if "Kd" in found:
        made.diffuse = colour(found["Kd"])
    if "Ke" in found:
        made.emission = colour(found["Ke"])
    specular = colour(found.get("Ks", ["0"]))
    if "map_Kd" in found:
        options = re.fullmatch(r"(?:-s (\S+) (\S+) )?(\S+)", " ".join(found["map_Kd"]))
        if not options:
            raise ValueError(f"{name}: map_Kd {' '.join(found['map_Kd'])}: expected [-s U V] FILE")
        made.texture = folder / options[3]
        made.texture_scale = (float(options[1] or 1), float(options[2] or 1))
    if model == 7 and max(made.diffuse) == 0.0:
        made.is_glass = True
        made.index = float(found.get("Ni", ["1"])[0])
        clear = 1.0 if opacity == 1.0 else 1.0 - opacity
        made.transmittance = tuple(clear * channel for channel in colour(found.get("Tf", ["1"])))
    elif model == 3 and opacity == 1.0:
        if 0.0 < max(specular) < max(made.diffuse):
            left_out.append(f"{name}: no mirror beside what is matte")
        elif max(specular) > 0.0:
            if max(made.diffuse) > 0.0:
                left_out.append(f"{name}: nothing matte beside the mirror")
            made.mirror, made.diffuse, made.texture = specular, (0.0, 0.0, 0.0), None
    elif model in (1, 2) and opacity == 1.0:
        if model == 2 and max(specular) > 0.0:
            left_out.append(f"{name}: no glossy highlight")
    else:
        raise ValueError(f"{name}: illum {model} with d {opacity:g}: Mitsuba has no such material")
    return made


def read_meshes(file: pathlib.Path, materials: dict[str, Material]) -> list[Mesh]:
    """Returns the meshes of an OBJ file, with convex polygons cut into fans."""
    vertices = {"v": [], "vn": [], "vt": []}
    corners: dict[tuple[str, str], list] = {}
    group = made_of = ""

    def index(word: str, kind: str) -> int:
        number = int(word) if word else 0
        return number - 1 if number >= 0 else len(vertices[kind]) + number

    for line in file.read_text().splitlines():
        word, *rest = line.split() or [""]
        if word in vertices:
            vertices[word].append([float(number) for number in rest[:3]])
        elif word in ("o", "g"):
            group = " ".join(rest)
        elif word == "usemtl":
            made_of = " ".join(rest)
        elif word == "f":
            fan = []
            for corner in rest:
                v, vt, vn = (corner.split("/") + ["", ""])[:3]
                fan.append((index(v, "v"), index(vt, "vt"), index(vn, "vn")))
            shines = max(materials[made_of].emission) > 0.0
            mine = corners.setdefault((made_of, group if shines else "", fan[0][2] >= 0), [])
            for second, third in zip(fan[1:], fan[2:]):
                mine += [fan[0], second, third]
    arrays = {kind: numpy.array(values, dtype=float) for kind, values in vertices.items()}
    meshes = []
    for (name, _, smooth), indices in corners.items():
        unique, faces = numpy.unique(numpy.array(indices), axis=0, return_inverse=True)
        mapped = materials[name].texture is not None
        meshes.append(Mesh(materials[name], arrays["v"][unique[:, 0]],
                           arrays["vn"][unique[:, 2]] if smooth else None,
                           arrays["vt"][unique[:, 1]] if mapped else None, faces.reshape(-1, 3)))
    return meshes


def read(file: pathlib.Path) -> Scene:
    """Returns the scene of a JSON file."""
    given = json.loads(file.read_text())
    obj = (file.parent / given.get("obj", file.with_suffix(".obj").name)).resolve()
    with obj.open() as lines:
        mtl = obj.parent / next(line.split()[1] for line in lines if line.startswith("mtllib"))
    left_out: list[str] = []
    materials = read_materials(mtl, left_out)
    camera = {"up": [0, 1, 0], "fov": 35} | {key: value for key, value in given["camera"].items() if key != "path"}
    return Scene(camera, read_meshes(obj, materials), given.get("point_lights", []),
                 given.get("area_lights", []), colour(given.get("background", 0.0)), left_out, obj, mtl)
