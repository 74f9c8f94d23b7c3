"""Reads a scene (JSON, OBJ, MTL) and writes it for Mitsuba: PLY files and `mitsuba.json`.

Supports the materials that both renderers have: matte, perfect mirrors, and clear refractive glass. Others, and textures, raise
ValueError. `mitsuba.json` is the dictionary for mitsuba.load_dict, except for camera transforms ("look_at"), which `mitsuba_worker`
makes.
"""

import dataclasses
import json
import pathlib

import numpy

Colour = tuple[float, float, float]
# Mitsuba's samplers; the first is its default.
SAMPLERS = ("independent", "stratified", "multijitter", "orthogonal", "ldsampler")
# Russian roulette begins after this number of surfaces; DEPTH limits paths. Raygate has the same values.
SURE_SURFACES = 3
DEPTH = 64


@dataclasses.dataclass
class Material:
    """The MTL statements that are used."""

    name: str
    diffuse: Colour = (0.8, 0.8, 0.8)
    mirror: Colour = (0.0, 0.0, 0.0)
    emission: Colour = (0.0, 0.0, 0.0)
    transmittance: Colour = (1.0, 1.0, 1.0)  # of glass
    index: float | None = None  # of glass


@dataclasses.dataclass
class Mesh:
    """All triangles of one material (and of one object, if they emit light)."""

    material: Material
    positions: numpy.ndarray  # n x 3
    normals: numpy.ndarray | None  # n x 3; None: flat
    faces: numpy.ndarray  # m x 3


@dataclasses.dataclass
class Scene:
    """A scene in the file's coordinates."""

    camera: dict  # eye, target, up, fov (vertical, in degrees)
    meshes: list[Mesh]
    point_lights: list[dict]  # position, intensity
    area_lights: list[dict]  # corner, edges, radiance
    background: Colour


def colour(value: object) -> Colour:
    """Returns a colour; a single number stands for three equal ones."""
    values = [float(word) for word in (value if isinstance(value, list) else [value])]
    return tuple(values * 3 if len(values) == 1 else values)


def read_materials(file: pathlib.Path) -> dict[str, Material]:
    """Returns the materials of an MTL file, by name."""
    statements: dict[str, dict[str, list[str]]] = {}
    for line in file.read_text().splitlines():
        word, *rest = line.split("#")[0].split() or [""]
        if word == "newmtl":
            mine = statements.setdefault(" ".join(rest), {})
        elif word:
            mine[word] = rest
    return {name: material(name, found) for name, found in statements.items()}


def material(name: str, found: dict[str, list[str]]) -> Material:
    """Returns one material from its statements."""
    made = Material(name, colour(found.get("Kd", ["0.8"])), emission=colour(found.get("Ke", ["0"])))
    model = int(found.get("illum", ["2"])[0])
    opacity = float(found.get("d", ["1"])[0])
    specular = colour(found.get("Ks", ["0"]))
    if model == 7 and max(made.diffuse) == 0.0:
        made.index = float(found.get("Ni", ["1"])[0])
        clear = 1.0 if opacity == 1.0 else 1.0 - opacity
        made.transmittance = tuple(clear * channel for channel in colour(found.get("Tf", ["1"])))
    elif model == 3 and opacity == 1.0 and 0.0 in (max(specular), max(made.diffuse)):
        made.mirror = specular
    elif model not in (1, 2) or opacity != 1.0 or (model == 2 and max(specular) > 0.0) or "map_Kd" in found:
        raise ValueError(f"{name}: illum {model} with d {opacity:g}: Mitsuba has no such material")
    return made


def read_meshes(file: pathlib.Path, materials: dict[str, Material]) -> list[Mesh]:
    """Returns the meshes of an OBJ file, with convex polygons cut into fans."""
    vertices = {"v": [], "vn": []}
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
            made_of = " ".join(rest) if " ".join(rest) in materials else ""
        elif word == "f":
            fan = []
            for corner in rest:
                v, _, vn = (corner.split("/") + ["", ""])[:3]
                fan.append((index(v, "v"), index(vn, "vn")))
            shines = max(materials[made_of].emission) > 0.0
            mine = corners.setdefault((made_of, group if shines else "", fan[0][1] >= 0), [])
            for second, third in zip(fan[1:], fan[2:]):
                mine += [fan[0], second, third]
    arrays = {kind: numpy.array(values, dtype=float) for kind, values in vertices.items()}
    meshes = []
    for (name, _, smooth), indices in corners.items():
        unique, faces = numpy.unique(numpy.array(indices), axis=0, return_inverse=True)
        meshes.append(Mesh(materials[name], arrays["v"][unique[:, 0]], arrays["vn"][unique[:, 1]] if smooth else None, faces.reshape(-1, 3)))
    return meshes


def read(file: pathlib.Path) -> Scene:
    """Returns the scene of a JSON file."""
    given = json.loads(file.read_text())
    obj = (file.parent / given.get("obj", file.with_suffix(".obj").name)).resolve()
    libraries = [obj.parent / line.split()[1] for line in obj.read_text().splitlines() if line.startswith("mtllib")]
    camera = {"up": [0, 1, 0], "fov": 35} | {key: value for key, value in given["camera"].items() if key != "path"}
    materials = {"": Material("")} | {name: made for mtl in libraries if mtl.exists() for name, made in read_materials(mtl).items()}
    return Scene(camera, read_meshes(obj, materials), given.get("point_lights", []),
                 given.get("area_lights", []), colour(given.get("background", 0.0)))


def rgb(values: object) -> dict:
    """Returns a colour in Mitsuba's format."""
    return {"type": "rgb", "value": [float(value) for value in values]}


def write_ply(mesh: Mesh, file: pathlib.Path) -> None:
    """Writes a binary PLY file."""
    columns = [("x", mesh.positions[:, 0]), ("y", mesh.positions[:, 1]), ("z", mesh.positions[:, 2])]
    if mesh.normals is not None:
        columns += [(f"n{axis}", mesh.normals[:, i]) for i, axis in enumerate("xyz")]
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(mesh.positions)}",
            *(f"property float {name}" for name, _ in columns), f"element face {len(mesh.faces)}",
            "property list uchar int vertex_indices", "end_header", ""]
    faces = numpy.empty(len(mesh.faces), dtype=[("n", "u1"), ("corners", "<i4", 3)])
    faces["n"], faces["corners"] = 3, mesh.faces
    with file.open("wb") as out:
        out.write("\n".join(head).encode())
        out.write(numpy.stack([values for _, values in columns], axis=1).astype("<f4").tobytes())
        out.write(faces.tobytes())


def bsdf(material: Material) -> dict:
    """Returns a Mitsuba material."""
    if material.index is not None:
        return {"type": "dielectric", "int_ior": material.index, "ext_ior": 1.0, "specular_transmittance": rgb(material.transmittance)}
    if max(material.mirror) > 0.0:
        inside = {"type": "conductor", "material": "none", "specular_reflectance": rgb(material.mirror)}
    else:
        inside = {"type": "diffuse", "reflectance": rgb(material.diffuse)}
    return {"type": "twosided", "inside": inside}


def is_closed(mesh: Mesh) -> bool:
    """Returns whether each edge belongs to two faces that traverse it in opposite directions."""
    places = {tuple(place): number for number, place in enumerate(numpy.unique(mesh.positions, axis=0))}
    faces = [[places[tuple(mesh.positions[corner])] for corner in face] for face in mesh.faces]
    edges = [(face[i], face[i - 2]) for face in faces for i in range(3)]
    return len(set(edges)) == len(edges) and {edge[::-1] for edge in edges} == set(edges)


def light_meshes(mesh: Mesh, everything: numpy.ndarray) -> list[Mesh]:
    """Returns meshes that emit like a light of raygate. Raygate's lights emit from both sides, Mitsuba's from the front. So the returned
    mesh faces the lit side. If both sides are lit, there are two meshes, 2e-5 of the scene's size apart. Closed lights stay unchanged."""
    if is_closed(mesh):
        return [mesh]
    a, b, c = mesh.positions[mesh.faces[0]]
    normal = numpy.cross(b - a, c - a)
    normal /= numpy.linalg.norm(normal)
    heights = (everything - a) @ normal
    flat = 1e-5 * float(numpy.ptp(everything, axis=0).max())
    sides = [side for side, lit in ((True, heights.max() > flat), (False, heights.min() < -flat)) if lit]
    apart = flat if len(sides) == 2 else 0.0
    return [Mesh(mesh.material, mesh.positions + (apart if front else -apart) * normal, None,
                 mesh.faces if front else mesh.faces[:, ::-1]) for front in sides]


def write_mitsuba(scene: Scene, side: int, folder: pathlib.Path) -> None:
    """Writes mitsuba.json, a PLY file for each mesh, and a camera of side x side pixels for each sampler."""
    everything = numpy.concatenate([mesh.positions for mesh in scene.meshes])
    found: dict = {"type": "scene", "integrator": {"type": "path", "rr_depth": SURE_SURFACES + 1, "max_depth": DEPTH + 2}}
    for sampler in SAMPLERS:
        found[f"camera_{sampler}"] = {
            "type": "perspective", "fov_axis": "y", "fov": scene.camera["fov"],
            "look_at": {"origin": scene.camera["eye"], "target": scene.camera["target"], "up": scene.camera["up"]},
            "film": {"type": "hdrfilm", "rfilter": {"type": "box"}, "pixel_format": "rgb",
                     "component_format": "float32", "width": side, "height": side},
            "sampler": {"type": sampler}}
    meshes = list(scene.meshes)
    for number, light in enumerate(scene.area_lights):
        corner, (along, across) = numpy.array(light["corner"], float), numpy.array(light["edges"], float)
        light = Material(f"light {number}", diffuse=(0.0, 0.0, 0.0), emission=colour(light["radiance"]))
        meshes.append(Mesh(light, numpy.array([corner, corner + along, corner + along + across, corner + across]),
                           None, numpy.array([[0, 1, 2], [0, 2, 3]])))
    for mesh in meshes:
        shines = max(mesh.material.emission) > 0.0
        for part in light_meshes(mesh, everything) if shines else [mesh]:
            name = f"mesh_{sum(key.startswith('mesh_') for key in found)}"
            write_ply(part, folder / f"{name}.ply")
            found[name] = {"type": "ply", "filename": f"{name}.ply", "face_normals": part.normals is None, "bsdf": bsdf(part.material)}
            if shines:
                found[name]["emitter"] = {"type": "area", "radiance": rgb(part.material.emission)}
    for number, light in enumerate(scene.point_lights):
        found[f"point_{number}"] = {"type": "point", "position": light["position"], "intensity": rgb(colour(light["intensity"]))}
    if max(scene.background) > 0.0:
        found["background"] = {"type": "constant", "radiance": rgb(scene.background)}
    (folder / "mitsuba.json").write_text(json.dumps(found, indent=1))
