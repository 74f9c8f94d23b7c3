"""A binary glTF file for Mitsuba, which reads none: meshes in the world's coordinates, materials as `principled`."""

import json
import pathlib
import struct

import mitsuba
import numpy

WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
NUMBERS = {5121: "<u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}


class Glb:
    """Its JSON and its numbers. Sound files alone: raygate has refused the others."""

    def __init__(self, file: pathlib.Path) -> None:
        data = file.read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20:20 + length])
        self._bytes = data[28 + length:]

    def view(self, number: int) -> bytes:
        """The bytes of a buffer view."""
        view = self.json["bufferViews"][number]
        start = view.get("byteOffset", 0)
        return self._bytes[start:start + view["byteLength"]]

    def array(self, number: int) -> numpy.ndarray:
        """The rows of an accessor."""
        accessor = self.json["accessors"][number]
        kind, width = numpy.dtype(NUMBERS[accessor["componentType"]]), WIDTHS[accessor["type"]]
        stride = self.json["bufferViews"][accessor["bufferView"]].get("byteStride", kind.itemsize * width)
        return numpy.ndarray((accessor["count"], width), kind, self.view(accessor["bufferView"]),
                             accessor.get("byteOffset", 0), (stride, kind.itemsize)).copy()

    def placed_meshes(self) -> list[tuple[dict, numpy.ndarray]]:
        """Meshes and the matrices that put them into the world."""
        found = []
        steps = [(node, numpy.eye(4)) for node in self.json["scenes"][self.json.get("scene", 0)]["nodes"]]
        while steps:
            number, parent = steps.pop()
            node = self.json["nodes"][number]
            world = parent @ local_matrix(node)
            steps += [(child, world) for child in node.get("children", [])]
            if "mesh" in node:
                found.append((self.json["meshes"][node["mesh"]], world))
        return found


def local_matrix(node: dict) -> numpy.ndarray:
    """Of a node, from its `matrix`, or translation, rotation and scale."""
    if "matrix" in node:
        return numpy.array(node["matrix"]).reshape(4, 4).T
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    matrix = numpy.eye(4)
    matrix[:3, :3] = numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                                  [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                                  [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    matrix[:3, :3] *= numpy.array(node.get("scale", [1, 1, 1]))
    matrix[:3, 3] = node.get("translation", [0, 0, 0])
    return matrix


def bsdf(glb: Glb, number: int | None, folder: pathlib.Path) -> dict:
    """Factors, and the texture of the base colour."""
    material = glb.json["materials"][number] if number is not None else {}
    pbr = material.get("pbrMetallicRoughness", {})
    factor = pbr.get("baseColorFactor", [1, 1, 1, 1])[:3]
    colour: dict = {"type": "rgb", "value": factor}
    if "baseColorTexture" in pbr:
        image = glb.json["images"][glb.json["textures"][pbr["baseColorTexture"]["index"]]["source"]]
        file = folder / f"picture{number}.{image['mimeType'].rpartition('/')[2]}"
        file.write_bytes(glb.view(image["bufferView"]))
        colour = {"type": "bitmap", "filename": str(file)}
    return {"type": "twosided", "inside": {
        "type": "principled", "base_color": colour, "metallic": pbr.get("metallicFactor", 1.0),
        "roughness": pbr.get("roughnessFactor", 1.0), "specular": 0.5}}


def mitsuba_meshes(file: pathlib.Path, folder: pathlib.Path) -> dict:
    """What load_dict takes: a PLY file in `folder` for each primitive."""
    glb, found = Glb(file), {}
    for mesh, world in glb.placed_meshes():
        for primitive in mesh["primitives"]:
            attributes = primitive["attributes"]
            positions = glb.array(attributes["POSITION"]) @ world[:3, :3].T + world[:3, 3]
            faces = glb.array(primitive["indices"]).reshape(-1, 3)
            name = f"mesh_{len(found)}"
            made = mitsuba.Mesh(name, len(positions), len(faces), has_vertex_normals="NORMAL" in attributes,
                                has_vertex_texcoords="TEXCOORD_0" in attributes)
            parameters = mitsuba.traverse(made)
            parameters["vertex_positions"] = positions.astype(numpy.float32).ravel()
            parameters["faces"] = faces.astype(numpy.uint32).ravel()
            if "NORMAL" in attributes:
                normals = glb.array(attributes["NORMAL"]) @ numpy.linalg.inv(world[:3, :3])
                parameters["vertex_normals"] = normals.astype(numpy.float32).ravel()
            if "TEXCOORD_0" in attributes:
                parameters["vertex_texcoords"] = glb.array(attributes["TEXCOORD_0"]).astype(numpy.float32).ravel()
            parameters.update()
            made.write_ply(str(folder / f"{name}.ply"))
            found[name] = {"type": "ply", "filename": str(folder / f"{name}.ply"),
                           "face_normals": "NORMAL" not in attributes,
                           "bsdf": bsdf(glb, primitive.get("material"), folder)}
    return found
