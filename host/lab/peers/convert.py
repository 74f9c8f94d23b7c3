"""Writes a scene in two formats into one folder: OBJ, MTL and JSON for raygate; PLY and `mitsuba.json` for Mitsuba.

`mitsuba.json` is the dictionary for mitsuba.load_dict, except for values that JSON cannot represent, which
`mitsuba_worker` fills in: a camera transform ("look_at") and a texture times a colour ("times").
"""

import json
import pathlib
import shutil

import numpy

from host.lab.peers.scene import Material, Mesh, Scene, colour

# Mitsuba's samplers; the first is its default.
SAMPLERS = ("independent", "stratified", "multijitter", "orthogonal", "ldsampler")
# Russian roulette begins after this number of surfaces; DEPTH limits paths. Both are those of raygate.
SURE_SURFACES = 3
DEPTH = 64


def rgb(values: object) -> dict:
    """Returns a colour in Mitsuba's format."""
    return {"type": "rgb", "value": [float(value) for value in values]}


def write_raygate(scene: Scene, folder: pathlib.Path) -> None:
    """Writes scene.json, with the OBJ file and an MTL file of the properties that both renderers support."""
    shutil.copyfile(scene.obj, folder / scene.obj.name)
    lines = []
    for material in {mesh.material.name: mesh.material for mesh in scene.meshes}.values():
        lines += [f"newmtl {material.name}"]
        for statement, values in (("Kd", material.diffuse), ("Ks", material.mirror), ("Ke", material.emission),
                                  ("Tf", material.transmittance)):
            lines += [" ".join([statement, *(f"{value:.9g}" for value in values)])]
        if material.texture:
            shutil.copyfile(material.texture, folder / material.texture.name)
            lines += ["map_Kd -s {:g} {:g} {}".format(*material.texture_scale, material.texture.name)]
        lines += [f"Ni {material.index:g}", "Ns 1",
                  f"illum {7 if material.is_glass else 3 if max(material.mirror) else 1}", ""]
    (folder / scene.mtl.name).write_text("\n".join(lines))
    (folder / "scene.json").write_text(json.dumps(
        {"obj": scene.obj.name, "camera": scene.camera, "point_lights": scene.point_lights,
         "area_lights": scene.area_lights, "background": list(scene.background)}, indent=1))


def write_ply(mesh: Mesh, file: pathlib.Path) -> None:
    """Writes a binary PLY file, with v of texture coordinates downwards, and scaled as in the texture lookup."""
    columns = [("x", mesh.positions[:, 0]), ("y", mesh.positions[:, 1]), ("z", mesh.positions[:, 2])]
    if mesh.normals is not None:
        columns += [(f"n{axis}", mesh.normals[:, i]) for i, axis in enumerate("xyz")]
    if mesh.texcoords is not None:
        u, v = (mesh.texcoords[:, i] * mesh.material.texture_scale[i] for i in range(2))
        columns += [("u", u), ("v", 1.0 - v)]
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
    if material.is_glass:
        return {"type": "dielectric", "int_ior": material.index, "ext_ior": 1.0,
                "specular_transmittance": rgb(material.transmittance)}
    if max(material.mirror) > 0.0:
        inside = {"type": "conductor", "material": "none", "specular_reflectance": rgb(material.mirror)}
    else:
        inside = {"type": "diffuse", "reflectance": rgb(material.diffuse) if material.texture is None else
                  {"type": "bitmap", "filename": material.texture.name, "times": list(material.diffuse)}}
    return {"type": "twosided", "inside": inside}


def light_sides(corners: numpy.ndarray, normal: numpy.ndarray, everything: numpy.ndarray) -> list[bool]:
    """Returns the sides of a flat light that face any geometry; True is the side of its normal."""
    heights = (everything - corners[0]) @ normal
    flat = 1e-5 * float(numpy.ptp(everything, axis=0).max())
    return [side for side, lit in ((True, heights.max() > flat), (False, heights.min() < -flat)) if lit]


def is_closed(mesh: Mesh) -> bool:
    """Returns whether each edge belongs to two faces that traverse it in opposite directions."""
    places = {tuple(place): number for number, place in enumerate(numpy.unique(mesh.positions, axis=0))}
    faces = [[places[tuple(mesh.positions[corner])] for corner in face] for face in mesh.faces]
    edges = [(face[i], face[i - 2]) for face in faces for i in range(3)]
    return len(set(edges)) == len(edges) and {edge[::-1] for edge in edges} == set(edges)


def light_meshes(mesh: Mesh, everything: numpy.ndarray) -> list[Mesh]:
    """Returns meshes that emit like a light of raygate, which emits from both sides, while Mitsuba's emit from the
    front: the light facing the lit side, or two copies for both sides, 1e-5 of the scene's size apart. Closed
    lights stay unchanged."""
    if is_closed(mesh):
        return [mesh]
    a, b, c = mesh.positions[mesh.faces[0]]
    normal = numpy.cross(b - a, c - a)
    normal /= numpy.linalg.norm(normal)
    sides = light_sides(mesh.positions[mesh.faces[0]], normal, everything)
    apart = 1e-5 * float(numpy.ptp(everything, axis=0).max()) if len(sides) == 2 else 0.0
    return [Mesh(mesh.material, mesh.positions + (apart if front else -apart) * normal, None, mesh.texcoords,
                 mesh.faces if front else mesh.faces[:, ::-1]) for front in sides]


def write_mitsuba(scene: Scene, folder: pathlib.Path) -> None:
    """Writes mitsuba.json, a PLY file for each mesh, and a camera for each sampler."""
    everything = numpy.concatenate([mesh.positions for mesh in scene.meshes])
    found: dict = {"type": "scene", "integrator": {"type": "path", "rr_depth": SURE_SURFACES + 1, "max_depth": DEPTH + 2}}
    for sampler in SAMPLERS:
        found[f"camera_{sampler}"] = {
            "type": "perspective", "fov_axis": "y", "fov": scene.camera["fov"],
            "look_at": {"origin": scene.camera["eye"], "target": scene.camera["target"], "up": scene.camera["up"]},
            "film": {"type": "hdrfilm", "rfilter": {"type": "box"}, "pixel_format": "rgb",
                     "component_format": "float32"},
            "sampler": {"type": sampler}}
    meshes = list(scene.meshes)
    for number, light in enumerate(scene.area_lights):
        corner, (along, across) = numpy.array(light["corner"], float), numpy.array(light["edges"], float)
        light = Material(f"light {number}", diffuse=(0.0, 0.0, 0.0), emission=colour(light["radiance"]))
        meshes.append(Mesh(light, numpy.array([corner, corner + along, corner + along + across, corner + across]),
                           None, None, numpy.array([[0, 1, 2], [0, 2, 3]])))
    for mesh in meshes:
        shines = max(mesh.material.emission) > 0.0
        for part in light_meshes(mesh, everything) if shines else [mesh]:
            name = f"mesh_{sum(key.startswith('mesh_') for key in found)}"
            write_ply(part, folder / f"{name}.ply")
            found[name] = {"type": "ply", "filename": f"{name}.ply", "face_normals": part.normals is None,
                           "bsdf": bsdf(part.material)}
            if shines:
                found[name]["emitter"] = {"type": "area", "radiance": rgb(part.material.emission)}
    for number, light in enumerate(scene.point_lights):
        found[f"point_{number}"] = {"type": "point", "position": light["position"],
                                    "intensity": rgb(colour(light["intensity"]))}
    if max(scene.background) > 0.0:
        found["background"] = {"type": "constant", "radiance": rgb(scene.background)}
    (folder / "mitsuba.json").write_text(json.dumps(found, indent=1))


def write(scene: Scene, folder: pathlib.Path) -> None:
    """Writes both formats."""
    folder.mkdir(parents=True, exist_ok=True)
    write_raygate(scene, folder)
    write_mitsuba(scene, folder)
