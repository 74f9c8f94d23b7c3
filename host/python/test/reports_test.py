"""Cases that public reports about other programs describe, as small inputs with the right answers.

A row of ROWS: the report, the files (the first is loaded), and what is expected. Adders of users are in synth/test/brought_test.py.
"""

import base64
import fractions
import io
import itertools
import json
import math
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import PIL.Image

import raygate

# A square that the camera and the rays see from z = 5, and its texture coordinates from the lower left corner.
CORNERS = [(-1., -1., 0.), (1., -1., 0.), (1., 1., 0.), (-1., 1., 0.)]
UV = [(0., 0.), (1., 0.), (1., 1.), (0., 1.)]
UV_DOWN = [(u, 1 - v) for u, v in UV]  # as glTF counts them
LETTERS = {"R": (1, 0, 0), "G": (0, 1, 0), "B": (0, 0, 1), "Y": (1, 1, 0), "C": (0, 1, 1), "W": (1, 1, 1), "K": (0, 0, 0)}
SQUARE = "".join("v %g %g %g\n" % corner for corner in CORNERS) + "".join("vt %g %g\n" % uv for uv in UV)
TEXTURED = "mtllib a.mtl\nusemtl m\n" + SQUARE + "f 1/1 2/2 3/3 4/4\n"
MTL = "newmtl m\nKd 1 1 1\nmap_Kd pic.png\n"


def image(letters="RG/BY", kind="png", size=1, mode="RGB", **options):
    """A picture with a square of `size` pixels for each letter, rows from the top; - is transparent."""
    rows = letters.split("/")
    picture = PIL.Image.new("RGBA", (len(rows[0]), len(rows)))
    picture.putdata([(*(255 * x for x in LETTERS.get(c, (0, 0, 0))), 0 if c == "-" else 255) for c in "".join(rows)])
    picture = picture.resize([size * x for x in picture.size], PIL.Image.NEAREST)
    out = io.BytesIO()
    picture = picture if mode == "RGBA" else picture.convert("RGB")
    (picture.quantize(4) if mode == "P" else picture.convert(mode)).save(out, kind, **options)
    return out.getvalue()


def uri(data, kind="application/octet-stream"):
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"


class Gltf:
    """The square of CORNERS as glTF. `json` may be changed before text()."""

    def __init__(self, picture=None, indices=(0, 1, 2, 0, 2, 3), **attributes):
        self.data = b""
        self.json = {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "scene": 0, "nodes": [{"mesh": 0}], "accessors": [], "bufferViews": []}
        attributes = {"POSITION": CORNERS, "TEXCOORD_0": UV_DOWN, **attributes}
        self.mesh = {"attributes": {name: self.add(values) for name, values in attributes.items()}, "material": 0}
        if indices:
            self.mesh["indices"] = self.add(indices, "H")
        self.material = {"pbrMetallicRoughness": {"metallicFactor": 0}}
        self.json |= {"meshes": [{"primitives": [self.mesh]}], "materials": [self.material]}
        if picture:
            self.json |= {"images": [{"uri": uri(picture, "image/png")}], "textures": [{"source": 0}]}
            self.material["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}

    def view(self, values, code="f"):
        flat = list(itertools.chain.from_iterable(v if isinstance(v, tuple) else (v,) for v in values))
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(flat) * struct.calcsize(code)})
        self.data += struct.pack(f"<{len(flat)}{code}", *flat)
        self.data += bytes(-len(self.data) % 4)
        return len(self.json["bufferViews"]) - 1

    def add(self, values, code="f", **members):
        """Adds an accessor of numbers or tuples."""
        width = len(values[0]) if isinstance(values[0], tuple) else 1
        self.json["accessors"].append({"bufferView": self.view(values, code), "componentType": {"f": 5126, "H": 5123, "B": 5121, "b": 5120}[code],
                                       "count": len(values), "type": {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}[width], **members})
        return len(self.json["accessors"]) - 1

    def text(self, **members):
        return json.dumps(self.json | {"buffers": [{"byteLength": len(self.data), "uri": uri(self.data)}]} | members)


def extension(name, value=None, required=False, where=None, gltf=None):
    gltf = gltf or Gltf()
    if where:
        where(gltf)["extensions"] = {name: value}
    return gltf.text(extensionsUsed=[name], **{"extensionsRequired": [name]} if required else {})


def node(gltf):
    return gltf.json["nodes"][0]


def nodes(*members, **attributes):
    gltf = Gltf(**attributes)
    return gltf.text(nodes=[{"mesh": 0} | more for more in members], scenes=[{"nodes": list(range(len(members)))}])


def of_mode(mode, indices):
    gltf = Gltf(indices=indices)
    gltf.mesh["mode"] = mode
    return gltf.text()


def morphed(**of_node):
    gltf = Gltf()
    gltf.mesh["targets"] = [{"POSITION": gltf.add([(0., 0., 2.)] * 4)}, {"POSITION": gltf.add([(1., 0., 0.)] * 4)}]
    gltf.json["meshes"][0]["weights"] = [0.5, 0.25]
    return gltf.text(nodes=[{"mesh": 0, **of_node}])


def sparse(corners, count=None, values=None, number=0):
    """Returns the square with sparse positions for corners with these indices; other corners are 0 or, if there is one index, unchanged."""
    gltf = Gltf(NORMAL=[(0., 0., 1.)] * 4)
    places = gltf.view([(3., 3., 0.) if k == 2 else CORNERS[k] for k in corners])
    gltf.json["accessors"][number]["sparse"] = {"count": count or len(corners), "indices": {"bufferView": gltf.view(corners, "H"), "componentType": 5123},
        "values": {"bufferView": places} if values is None else values}
    if len(corners) > 1:
        del gltf.json["accessors"][0]["bufferView"]
    return gltf.text()


def quantised(code, scale):
    gltf = Gltf(image())
    for name, values in (("POSITION", [(u, v, 0) for u, v in UV]), ("TEXCOORD_0", UV_DOWN)):
        gltf.mesh["attributes"][name] = gltf.add([tuple(int(scale * x) for x in v) for v in values], code, normalized=True)
    node(gltf).update(scale=[2, 2, 1], translation=[-1, -1, 0])
    return extension("KHR_mesh_quantization", required=True, gltf=gltf)


def skinned(joint, own):
    gltf = Gltf(WEIGHTS_0=[(1., 0., 0., 0.)] * 4)
    gltf.mesh["attributes"]["JOINTS_0"] = gltf.add([(0, 0, 0, 0)] * 4, "B")
    inverse = gltf.add([tuple(float(i % 5 == 0) for i in range(16))])
    return gltf.text(nodes=[{"mesh": 0, "skin": 0, **own}, joint], scenes=[{"nodes": [0, 1]}], skins=[{"joints": [1], "inverseBindMatrices": inverse}])


def material(picture=None, more=None, texture=None, sampler=None, **attributes):
    gltf = Gltf(picture, **attributes)
    gltf.material.update(more or {})
    if texture:
        gltf.material["pbrMetallicRoughness"]["baseColorTexture"].update(texture)
    if sampler:
        gltf.json |= {"samplers": [{"magFilter": 9728, "minFilter": 9728, **sampler}], "textures": [{"source": 0, "sampler": 0}]}
    return gltf


def before_blue(mode, cutoff=0.5, alpha=0.):
    """Returns a square with vertex alpha in front of a blue square."""
    gltf = material(more={"alphaMode": mode, "alphaCutoff": cutoff}, COLOR_0=[(1., 0., 0., alpha)] * 4)
    back = {"attributes": {"POSITION": gltf.add([(3 * x, 3 * y, -1.) for x, y, _ in CORNERS])}, "indices": gltf.mesh["indices"], "material": 1}
    gltf.json["materials"].append({"pbrMetallicRoughness": {"metallicFactor": 0, "baseColorFactor": [0, 0, 1, 1]}})
    gltf.json["meshes"][0]["primitives"].append(back)
    return gltf.text()


def normal_mapped(**attributes):
    out = io.BytesIO()
    PIL.Image.new("RGB", (2, 2), (222, 128, 213)).save(out, "png")
    gltf = material(out.getvalue(), {"normalTexture": {"index": 0}}, NORMAL=[(0., 0., 1.)] * 4, **attributes)
    del gltf.material["pbrMetallicRoughness"]["baseColorTexture"]
    return gltf.text()


def light(**members):
    gltf = Gltf()
    gltf.json["extensions"] = {"KHR_lights_punctual": {"lights": [members]}}
    return extension("KHR_lights_punctual", {"light": 0}, where=node, gltf=gltf)


def ply(header, body, form="ascii"):
    return f"ply\nformat {form} 1.0\n{header}end_header\n{body}"


VERTICES = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
FACES = "element face 1\nproperty list uchar int vertex_indices\n"
POINTS = "".join("%g %g %g\n" % corner for corner in CORNERS)


def ply_with(properties, values, faces=FACES, face="4 0 1 2 3\n", comment=""):
    """Returns the square with further properties and values of vertices."""
    return ply(comment + VERTICES + "".join(f"property {p}\n" for p in properties) + faces,
               "".join(f"{point} {value}\n" for point, value in zip(POINTS.splitlines(), values)) + face)


def binary_ply(sign, size, code, number, entry):
    header = VERTICES + f"property int flags\nelement face 1\nproperty list {size} {number} vertex_index\n"
    return (ply(header, "", f"binary_{'little' if sign == '<' else 'big'}_endian").encode()
            + b"".join(struct.pack(sign + "fffi", *corner, 7) for corner in CORNERS) + struct.pack(f"{sign}{code}4{entry}", 4, 0, 1, 2, 3))


def stl(name="solid a", end="endsolid a\n", upper=False):
    facets = "".join("facet normal 0 0 1\nouter loop\n" + "".join("vertex %g %g %g\n" % CORNERS[k] for k in facet) + "endloop\nendfacet\n"
                     for facet in ((0, 1, 2), (0, 2, 3)))
    return f"{name}\n{facets.upper() if upper else facets}{end}"


def binary_stl(start=b"", count=2, tail=b"", normal=(0, 0, 1)):
    return start.ljust(80) + struct.pack("<I", count) + b"".join(
        struct.pack("<12fH", *normal, *(x for k in facet for x in CORNERS[k]), 0) for facet in ((0, 1, 2), (0, 2, 3))) + tail


def with_texture(name, data, mtl=MTL):
    return {"a.obj": TEXTURED, "a.mtl": mtl.replace("pic.png", name), name: data}


def coloured(colour):
    return re.sub("^(v .*)$", rf"\1 {colour}", SQUARE, flags=re.MULTILINE)


FLAT = "normal without a direction, the face is taken as flat"
NO_UV = "face corner without texture coordinates, the face has no texture"
SHORT = "face of fewer than 3 corners, left out"
NO_AREA = "face of zero area, left out"
HOLE = {"a.obj": TEXTURED + "usemtl back\nv -3 -3 -2\nv 3 -3 -2\nv 3 3 -2\nv -3 3 -2\nf 5 6 7 8\n", "pic.png": image(),
        "mask.png": image("-W/WW", mode="RGBA"), "a.mtl": MTL + "map_d mask.png\nnewmtl back\nKd 0 1 1\n"}
LOWER, UPPER = (0.5, -0.5), (-0.5, 0.5)  # places in the two triangles

# Report, files, and keywords of Reports.check().
ROWS = [
    # OBJ and MTL.
    ("obj2gltf#243", {"a.obj": SQUARE + "vn nan nan nan\nvn 0 0 1\nf 1//1 2//2 3//2 4//2\n"}, {"warns": [FLAT]}),
    ("obj2gltf#243", {"a.obj": SQUARE + "vn -nan(ind) 0 0\nvn 1.#QNAN 0 1\nf 1//1 2//2 3//2 4//2\n"}, {"warns": [FLAT]}),
    ("obj2gltf#243", {"a.obj": SQUARE + "vt nan 0\nf 1/5 2/2 3/3 4/4\n"}, {"warns": [NO_UV]}),
    ("three.js#9204, tobj#36", {"a.obj": SQUARE + "f 1\nf 1 2\nf 1 2 3\n"}, {"rays": [LOWER], "warns": [SHORT]}),
    ("three.js#9204", {"a.obj": SQUARE + "vn 0 0 1\nf 1/1/1 2//1 3/3/1\n"}, {"rays": [LOWER], "warns": [NO_UV]}),
    ("tinyobjloader#385", {"a.obj": TEXTURED.replace("a.mtl", "my colours.mtl"), "pic two 01.png": image(),
                           "my colours.mtl": "newmtl m\nKd 1 1 1\nmap_Kd -o 0.5 0 0 -s 1 1 1 -clamp off pic two 01.png\n"}, {"colours": "GR/YB"}),
    *(("meshlab#66, tinyobjloader-c#71", {"a.obj": TEXTURED.replace("a.mtl", name), "my colours.mtl": MTL, "second.mtl": "newmtl n\n", "pic.png": image()}, {"colours": "RG/BY"})
      for name in ('"my colours.mtl" "second.mtl"', r"my\ colours.mtl")),
    ("vol_cl_tools#13, f3d#1973", {"a.obj": "usemtl m\nmtllib ./elsewhere.mtl\n" + SQUARE + "f 1 2 3 4\n", "a.mtl": "newmtl m\nKd 0 0 1\n",
                                   "elsewhere.mtl": "newmtl m\nKd 1 0 0\n"}, {"colours": "RR/RR"}),
    ("tinyobjloader#106, meshlab#1137", {"a.obj": TEXTURED, "textures/pic.png": image(),
                                         "a.mtl": "newmtl m\n\tKd 1 1 1\n\td 1.0\n\tTr 0.0\n\tmap_Kd textures\\pic.png\n"}, {"colours": "RG/BY"}),
    ("galacean/engine#2078, rbfx#550", HOLE, {"colours": "CG/BY", "triangles": "30/00", "depths": "75/55"}),
    ("UltimateDoomBuilder#495", with_texture("pic.png", image()) | {"a.mtl": MTL.replace("pic.png", "C:\\Users\\Someone\\Pic.PNG")},
     {"colours": "RG/BY", "warns": [r"'C:\\Users\\Someone\\Pic.PNG' is missing"]}),
    ("UltimateDoomBuilder#495", {"a.obj": TEXTURED.replace("a.mtl", "A.MTL"), "a.mtl": MTL, "pic.png": image()},
     {"colours": "RG/BY", "warns": ["'A.MTL' is missing"]}),
    ("tobj#54", {"a.obj": "mtllib a.mtl\nv -1 -1 0 1 0 0\nv 0 -1 0 1 0 0\nv 0 1 0 1 0 0\nv -1 1 0 1 0 0\nusemtl plain\nf 1 2 3 4\n"
                          "v 0 -1 0\nv 1 -1 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 5/1 6/2 7/3 8/4\n",
                 "a.mtl": MTL + "newmtl plain\nKd 1 1 1\n", "pic.png": image("B")}, {"colours": "RB/RB"}),
    ("godot#71033, three.js#23340", {"a.obj": coloured(".5 .5 .5") + "f 1 2 3 4\n"}, {"albedo": 0.2140}),
    ("godot#71033, three.js#23342", {"a.ply": ply_with(["uchar red", "uchar green", "uchar blue"], ["128 128 128"] * 4)}, {"albedo": 0.2159}),
    ("glTF-Blender-Exporter#206", {"a.gltf": Gltf(COLOR_0=[(128 / 255,) * 3] * 4).text()}, {"albedo": 0.5020}),
    ("obj2gltf#79, trimesh#2560", {"a.obj": "v 0 0 0\r\nv 3 0 0\r\nv 3 2 0\r\nv 2 2 0\r\nv 2 1 0\r\nv 1 1 0\r\nv 1 2 0\r\nv 0 2 0\r\nf 1 2 3 \\\r\n4 5 \\\r\n6 7 8\r\n"},
     {"rays": [(.5, 1.5), (1.5, 1.5), (2.5, 1.5), (1.5, .5)], "distances": [5, math.inf, 5, 5]}),
    ("wings#391, mayo#341", {"a.obj": SQUARE + "f 1// 2// 3// 4//\n"}, {}),
    ("assimp#2435", {"a.obj": SQUARE + "f 1/1/ 2/2/ 3/3/ 4/4/\n"}, {}),
    *(("assimp#2435", {"a.obj": SQUARE + f"vn 0 0 1\nf 1/{uv}/1 2/{uv}/1 3/{uv}/1\n"}, {"rays": [LOWER], "warns": [NO_UV]}) for uv in (9, 0)),
    *(("corners without a normal", {"a.obj": SQUARE + f"vn 0 1 1\nf 1/1/1 2/2{corner} 3/3/1 4/4/1\n"}, {"warns": [":10: face corner without a normal"], "normal": (0, 0, 1)})
      for corner in ("", "/2")),
    ("colours that are no numbers", {"a.obj": SQUARE + "v 0 0 0 1 nan x\nf 1 2 3 4\nf 1 2 5\n"},
     {"warns": [": 1 colours of vertices that are not finite numbers, taken as white"]}),
    *(("io_scene_owm#43, glTF#2333", with_texture(f"pic.{kind}", data), {"colours": "WW/WW", "warns": [f"pic.{kind}"]})
      for kind, data in (("tif", b"II*\0"), ("dds", b"DDS "), ("webp", b"RIFF"), ("psd", b"8BPS"), ("exr", b"v/1\1"), ("png", b""),
          ("png", image()[:40]))),
    ("weights of vertices", {"a.obj": SQUARE.replace("0\nv", "0 0.5\nv") + "f 1 2 3 4\n"}, {"warns": ["weights are ignored"]}),
    *(("encodings", {"a.obj": text}, {}) for text in ("\ufeff" + SQUARE + "f 1 2 3 4\n", SQUARE.replace("\n", "\r") + "f 1 2 3 4",
                                                      ("# Stra\xdfe\n" + SQUARE + "f 1 2 3 4\n").encode("latin1"))),
    ("encodings", {"a.obj": (SQUARE + "f 1 2 3 4\n").encode("utf-16")}, {"error": ":1: UTF-16 text, expected ASCII or UTF-8"}),
    ("encodings", {"a.obj": "v 0,5 0 0\n"}, {"error": ":1: v: found '0,5', expected a number"}),
    # STL.
    *(("numpy-stl#156", {"a.stl": text}, {}) for text in (stl(" solid a"), stl("\nsolid a"), "\ufeff" + stl(), stl().replace("\n", "\r\n"))),
    ("numpy-stl#206", {"a.stl": stl(end="end solid a\n")}, {}),
    ("numpy-stl#206", {"a.stl": stl(end="")}, {"warns": ["ends without endsolid"]}),
    *(("jsc3d#2", {"a.stl": text}, {}) for text in (stl("SOLID a", "ENDSOLID a\n", True), stl("Solid a"))),
    *(("minirender#2, assimp#102", {"a.stl": binary_stl(start, tail=tail)}, {})
      for start in (b"", b"solid a", b"solid a\nfacet normal") for tail in (b"", bytes(37))),
    *(("assimp#4909", {"a.stl": binary_stl(count=count)}, {"error": f"found 184 bytes, expected {84 + 50 * count} for the {count} facets"})
      for count in (0, 3, 2**32 - 1)),
    ("assimp#4909", {"a.stl": binary_stl(count=1)}, {"rays": [LOWER], "warns": ["room for 1 facets? after the 1 that its header counts"]}),
    ("normals that are no numbers", {"a.stl": binary_stl(normal=(math.nan,) * 3)}, {}),
    # PLY.
    ("trimesh#906, three.js#14735", {"a.ply": ply_with(["float s", "float t"], ["%g %g" % uv for uv in UV], comment="comment TextureFile pic.png\n")},
     {"warns": ["not read: texture 'pic.png', 's' of vertex, 't' of vertex"]}),
    ("meshlab#1543, assimp#836", {"a.ply": ply_with([], [""] * 4, FACES + "property list uchar float texcoord\n", "4 0 1 2 3 8 0 0 1 0 1 1 0 1\n")},
     {"warns": ["not read: 'texcoord' of face"]}),
    *(("mLib#15", {"a.ply": binary_ply(sign, *size, *number)}, {"warns": ["not read: 'flags' of vertex"]})
      for sign, size, number in itertools.product("<>", (("int", "i"), ("ushort", "H"), ("char", "b")), (("int", "i"), ("uint", "I"), ("uchar", "B")))),
    *(("meshlab#463", {"a.ply": ply(VERTICES + FACES, POINTS + "4 0 1 2 3\n").replace("\n", end)}, {}) for end in ("\r\n", "\r")),
    *(("meshlab#463", {"a.ply": ply(VERTICES + FACES, "", "binary_little_endian").replace("\n", end).encode()
                       + struct.pack("<12fB4i", *itertools.chain(*CORNERS), 4, 0, 1, 2, 3)}, {}) for end in ("\r\n", "\r")),
    ("tobj#36", {"a.ply": ply(VERTICES + FACES.replace("face 1", "face 3"), POINTS + "2 0 1\n0\n4 0 1 2 3\n")}, {"warns": [SHORT]}),
    *(("kinds of colours", {"a.ply": ply_with([f"{kind} {c}" for c in ("red", "green", "blue")], [f"{full} 0 0"] * 4)}, {"colours": "RR/RR"})
      for kind, full in (("uchar", 255), ("ushort", 65535), ("float", 1))),
    ("kinds of colours", {"a.ply": ply_with(["uchar red", "uchar green", "uchar blue", "uchar alpha"], ["0 0 255 9"] * 4)},
     {"colours": "BB/BB", "warns": ["not read: 'alpha' of vertex"]}),
    ("trimesh#1494, #790, #44", {"a.ply": ply(VERTICES + FACES.replace("face 1", "face 3"), POINTS + "3 0 1 1\n3 0 1 2\n3 0 2 3\n")},
     {"rays": [LOWER, UPPER], "numbers": [1, 2], "warns": [NO_AREA]}),
    ("trimesh#1494, #790, #44", {"a.obj": SQUARE + "f 1 2 2\nf 1 2 3\nf 1 3 4\n"}, {"rays": [LOWER, UPPER], "numbers": [1, 2], "warns": [NO_AREA]}),
    # Binary32 cannot represent these corners. In the last row, rounding would move an edge by 0.2.
    ("three-mesh-bvh#112, Open3D#5777", {"a.obj": "v 500000.125 4649776.25 0\nv 500001.125 4649776.25 0\nv 500000.125 4649777.25 0\nf 1 2 3\n"},
     {"rays": [(500000.375, 4649776.5)]}),
    ("three-mesh-bvh#112 and a stray face", {"a.obj": "v 500000 4649776.3 0\nv 500001 4649776.3 0\nv 500000 4649778.3 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n"},
     {"rays": [(500000.25, 4649777), (500000.5, 4649776.301)]}),
    # glTF: geometry.
    ("three.js#11796, cesium#9666", {"a.gltf": morphed()}, {"rays": [(1.2, .5), (-.8, .5)], "distances": [4, math.inf]}),
    ("weights of a node", {"a.gltf": morphed(weights=[0, 0.5])}, {"rays": [(1.4, .5), (-.6, .5)], "distances": [5, math.inf]}),
    *(("godot#76875, three.js#12596, gltf-rs#266", {"a.gltf": sparse(corners)},
       {"rays": [(1.5, 1.5), LOWER], "numbers": [0, 0]}) for corners in ([2], [0, 1, 2, 3])),
    ("sparse accessors", {"a.gltf": sparse([0, 1, 2])}, {"rays": [LOWER], "warns": [NO_AREA]}),
    ("sparse accessors", {"a.gltf": sparse([2], count=9)}, {"error": r"accessor 0 \(POSITION\): beyond its buffer"}),
    ("sparse accessors", {"a.gltf": sparse([2], values={})}, {"error": r"accessor 0 \(POSITION\): found no buffer view, expected its number"}),
    ("sparse accessors", {"a.gltf": sparse([2], values={}, number=2)}, {"warns": [r"accessor 2 \(NORMAL\): found no buffer view, expected its number, left out"]}),
    ("normals that are no numbers", {"a.gltf": Gltf(NORMAL=[(math.nan, 0., 1.), *[(0., 1., 1.)] * 3]).text()}, {"warns": [FLAT], "normal": (0, 0, 1)}),
    ("colours between corners", {"a.gltf": Gltf(COLOR_0=[(1., 0., 0.)] * 2 + [(0., 0., 1.)] * 2).text()}, {"colours": "BB/RR"}),
    ("attributes of others", {"a.gltf": Gltf(COLOR_1=[(1., 1., 1.)] * 4).text()}, {"warns": ["the attribute 'COLOR_1' is not read"]}),
    ("castle-engine#336, glTF#2059", {"a.gltf": nodes({"scale": [-1, 1, 1]})}, {"sides": [-1]}),
    ("glTF-Sample-Models#273", {"a.gltf": nodes({"scale": [1, -2, .5]})}, {"rays": [(.5, 1.7)], "sides": [-1]}),
    ("glTF-Sample-Models#273", {"a.gltf": nodes({"scale": [0, 0, 0]}, {})}, {"numbers": [2]}),
    *(("glTFRuntime#57, three.js#21553", {"a.gltf": quantised(code, scale)}, {"colours": "RG/BY"}) for code, scale in (("H", 65535), ("B", 255))),
    *(("fans and strips", {"a.gltf": of_mode(mode, indices)}, {"rays": [(0, -.5), (0, .5)], "numbers": [0, 1], "sides": [-1, -1]})
      for mode, indices in ((6, None), (5, (0, 1, 3, 2)))),
    ("lines alone", {"a.gltf": of_mode(1, (0, 1))}, {"error": "no faces, expected at least one polygon"}),
    ("glTF#2402, glTFast#107", {"a.gltf": extension("EXT_mesh_gpu_instancing", {}, True, node)},
     {"error": "'EXT_mesh_gpu_instancing', which is not read"}),
    ("nodes that are hidden", {"a.gltf": extension("KHR_node_visibility", {"visible": False}, where=node)},
     {"warns": ["the extension 'KHR_node_visibility' is not read"]}),
    *(("glTF-Sample-Assets#263, Babylon.js#3846", {"a.gltf": skinned(joint, own)}, {"rays": [(.2, -.3)], "distances": [distance]})
      for joint, own, distance in (({}, {"translation": [9, 0, 0]}, 5), ({"translation": [0, 0, 3]}, {}, 2), ({"scale": [.5, .5, 1]}, {}, 5))),
    # glTF: materials, lights and pictures.
    ("mesh-viewer#56, godot#38335", {"a.gltf": extension("KHR_materials_pbrSpecularGlossiness")},
     {"warns": ["'KHR_materials_pbrSpecularGlossiness' is not read"]}),
    ("mesh-viewer#56", {"a.gltf": extension("KHR_materials_pbrSpecularGlossiness", required=True)},
     {"error": "'KHR_materials_pbrSpecularGlossiness', which is not read"}),
    *((f"three.js#21466, {mode}", {"a.gltf": before_blue(mode)}, {"colours": colours}) for mode, colours in (("MASK", "BB/BB"), ("OPAQUE", "RR/RR"))),
    ("glTF#1293", {"a.gltf": before_blue("MASK", 0.25, 0.25)}, {"colours": "RR/RR"}),
    ("glTF#1293", {"a.gltf": before_blue("MASK", 1.5, 1.)}, {"colours": "BB/BB"}),
    *((f"psz-godot#576, {s} {t}", {"a.gltf": material(image(), sampler={"wrapS": s, "wrapT": t}, TEXCOORD_0=[(2 * u, 2 - 2 * v) for u, v in UV]).text()}, {"colours": colours})
      for s, t, colours in ((33648, 10497, "RGGR/BYYB/RGGR/BYYB"), (10497, 33648, "RGRG/BYBY/BYBY/RGRG"), (33648, 33648, "RGGR/BYYB/BYYB/RGGR"),
          (33071, 10497, "RGGG/BYYY/RGGG/BYYY"))),
    ("QGIS#54183", {"a.gltf": material(image(), sampler={"wrapS": 10242}).text()}, {"colours": "RG/BY", "warns": ["wrap mode 10242"]}),
    ("three.js#34032, glTF-Blender-IO#2366", {"a.gltf": extension("KHR_texture_transform", required=True, gltf=material(image(), texture={
        "extensions": {"KHR_texture_transform": {"rotation": math.pi / 2}}}))}, {"colours": "BR/YG"}),
    ("scaled, turned and moved", {"a.gltf": material(image(), texture={"extensions": {"KHR_texture_transform": {
        "rotation": math.pi / 2, "scale": [1, 2], "offset": [0, .5]}}}).text()}, {"colours": "RRBB/GGYY/RRBB/GGYY"}),
    *(("tinygltf#228, godot#47823, meshoptimizer#138", {"a.gltf": material(image()).text(images=[{"uri": name}]), file: image()},
       {"colours": "RG/BY"})
      for name, file in (("a%20b.png", "a b.png"), ("a b.png", "a b.png"), ("50%25.png", "50%.png"), ("ü.png", "ü.png"),
          ("tex%5Cinner.png", "tex/inner.png"))),
    ("tinygltf#228", {"a.gltf": material(image()).text(images=[{"uri": "C:%5CTextures%5CPic.PNG"}]), "pic.png": image()},
     {"colours": "RG/BY", "warns": [r"'C:\\Textures\\Pic.PNG' is missing, "]}),
    *(("images that are none", {"a.gltf": material(image()).text(images=[picture]), "empty.png": b""}, {"colours": "WW/WW", "warns": [warning]})
      for picture, warning in (
          ({}, "image 0 has no picture, its material is plain instead"), ({"uri": "data:image/png;base64,"}, "image 0 has no picture"),
          ({"uri": "empty.png"}, "empty.png: the file is empty, its material is plain instead"), ({"uri": "none.png"}, "the texture 'none.png' is missing"),
          ({"bufferView": 0, "mimeType": "image/webp"}, "image 0: not a PNG, JPEG, TGA or BMP picture"),
          ({"bufferView": 9}, "buffer view 9, but the file has 3, its material is plain instead"),
          ({"uri": "data:image/x-png," + 9000 * "A"}, "^.*the texture 'data:image/x-png,AAA.{1,120}$"))),
    ("images that are none", {"a.gltf": (lambda gltf: gltf.text(images=[{"bufferView": 0}], bufferViews=[
        {"buffer": 0, "byteLength": 9999999}, *gltf.json["bufferViews"][1:]]))(material(image()))}, {"error": "beyond its buffer"}),
    *(("members that are none", {"a.gltf": material(image(), texture=texture).text()}, {"colours": "WW/WW"})
      for texture in ({"texCoord": -7}, {"extensions": {"KHR_texture_transform": {"texCoord": 1e300}}})),
    *(("members that are none", {"a.gltf": material(more=more).text(textures=[{}])}, {"warns": [warning]}) for more, warning in (
        ({"normalTexture": {}}, "'normalTexture' of a material is not as glTF has it, left out"),
        ({"emissiveFactor": [1]}, "'emissiveFactor' of a material is not as glTF has it, left out"),
        ({"occlusionTexture": {"index": 0}}, "occlusionTexture is not read"),
        ({"normalTexture": {"index": 3}}, "texture 3, but the file has 1, its material is plain instead"))),
    *(("members that are none", {"a.gltf": Gltf().text(nodes=[{"mesh": 0} | of_node], **more)}, {"warns": [warning]}) for of_node, more, warning in (
        ({"camera": 0}, {"cameras": [{"type": "perspective"}]}, "a camera's yfov: expected more than 0 and less than pi, left out"),
        ({"camera": 2}, {}, "camera 2, but the file has 0, left out"), ({"skin": 0}, {"skins": [{}]}, "a skin without joints is left out"),
        ({}, {"animations": [{"samplers": [{}]}]}, "animations are not read"))),
    *(("lights that are none", {"a.gltf": light(**members)}, {"warns": [warning]}) for members, warning in (
        ({"type": "spot"}, "a spot light without 'spot' has the usual cone"), ({"type": "point", "intensity": -1}, "a light's intensity: expected no negative"),
        ({}, "found a light of the type '', expected directional, point or spot, left out"))),
    ("kinds of data URIs", {"a.gltf": material(image()).text(images=[{"uri": uri(image(), "image/png;charset=utf-8")}])}, {"colours": "RG/BY"}),
    ("kinds of data URIs", {"a.gltf": material(image()).text(images=[{"uri": uri(bytes(3000), "image/webp")}])},
     {"colours": "WW/WW", "warns": ["^.{1,250}$"]}),
    ("glTF-Sample-Models#149", {"a.gltf": normal_mapped()}, {"normal": (.74, 0, .67)}),
    ("glTF-Sample-Models#149", {"a.gltf": normal_mapped(TEXCOORD_0=[(1 - u, v) for u, v in UV_DOWN])}, {"normal": (-.74, 0, .67)}),
    ("DiligentFX#267", {"a.gltf": normal_mapped(TANGENT=[(0., 1., 0., 1.)] * 4)}, {"normal": (0, .74, .67)}),
    *(("cesium-native#609, three.js#20539", {"a.gltf": extension(name, {"source": 0}, where=lambda gltf: gltf.json["textures"][0], gltf=material(image()))},
       {"colours": "RG/BY", "warns": [f"the extension '{name}' is not read"]})
      for name in ("KHR_texture_basisu", "EXT_texture_webp", "MSFT_texture_dds")),
    *(("GearVRf#941, glTF-Blender-IO#2349", {"a.gltf": light(type="spot", spot=cone)}, {"warns": warns}) for cone, warns in (
        ({"innerConeAngle": .5, "outerConeAngle": .5}, []), ({"innerConeAngle": 0.}, []), ({"innerConeAngle": 1., "outerConeAngle": .5}, ["angles are limited"]))),
    ("two sets of texture coordinates", {"a.gltf": material(image(), texture={"texCoord": 1}, TEXCOORD_1=[(1 - u, v) for u, v in UV_DOWN]).text()},
     {"colours": "GR/YB"}),
    # Kinds of PNG, JPEG, BMP and TGA.
    *(("compressonator#181, astc-encoder#463", with_texture("pic.png", image(mode=mode, **options)), {"colours": "RG/BY"})
      for mode, options in (("RGB", {}), ("RGBA", {}), ("P", {}), ("P", {"bits": 2}), ("RGB", {"transparency": (1, 2, 3)}))),
    *(("zune-image#442", with_texture("pic.jpg", image("RG/BY", "jpeg", 32, mode, **options)), {"colours": "RG/BY"})
      for mode, options in (("RGB", {}), ("RGB", {"progressive": True}), ("CMYK", {}), ("RGB", {"restart_marker_rows": 1}))),
    *(("brl.mod#64", with_texture(f"pic.{kind}", image(kind=kind, mode=mode, **options)), {"colours": "RG/BY"})
      for kind, mode, options in (("bmp", "RGB", {}), ("bmp", "P", {}), ("tga", "RGB", {}), ("tga", "RGB", {"compression": "tga_rle"}), ("tga", "P", {}))),
]


def load(folder, files):
    for name, data in files.items():
        path = folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return raygate.Scene(folder / next(iter(files)))


class Reports(unittest.TestCase):
    def test_rows(self):
        for number, (report, files, expected) in enumerate(ROWS):
            with self.subTest(report, row=number), tempfile.TemporaryDirectory() as folder:
                if "error" in expected:
                    with self.assertRaisesRegex(raygate.InputError, expected["error"]):
                        load(pathlib.Path(folder), files)
                else:
                    self.check(load(pathlib.Path(folder), files), **expected)

    def check(self, scene, warns=(), rays=(LOWER,), numbers=None,
        distances=None, sides=None, colours=None, triangles=None, depths=None, albedo=None, normal=None):
        """`rays`: (x, y), down from z = 5. `colours` (LETTERS), `triangles`, `depths` (digits): a character per pixel, / between rows."""
        self.assertEqual(len(scene.warnings), len(warns), scene.warnings)
        for warning, pattern in zip(scene.warnings, warns):
            self.assertRegex(warning, pattern)
        hits = scene.trace([(x, y, 5) for x, y in rays], (0, 0, -1), columns=["triangle", "t", "side"])
        np.testing.assert_allclose(hits["t"], distances or 5, rtol=1e-6)
        if numbers:
            self.assertEqual(hits["triangle"].tolist(), numbers)
        if sides:
            self.assertEqual(hits["side"].tolist(), sides)
        shown = colours or triangles or "K"
        if colours or albedo or normal:
            size = len(shown.split("/"))
            picture = scene.render(size, size, eye=(0, 0, 5), target=(0, 0, 0), up=(0, 1, 0), fov=math.degrees(2 * math.atan(0.2)), spp=1, integrator="primary")
            mean = picture["albedo"].reshape(-1, 3)
            if colours:
                names, values = zip(*LETTERS.items())
                nearest = np.argmin(((mean[:, None] - np.array(values)) ** 2).sum(2), axis=1)
                self.assertEqual("/".join(re.findall("." * size, "".join(names[k] for k in nearest))), colours)
            if albedo:
                np.testing.assert_allclose(mean, albedo, atol=1e-4)
            if normal:
                np.testing.assert_allclose(picture["normal"].reshape(-1, 3), [normal] * size**2, atol=0.01)
            if triangles:
                self.assertEqual(picture["triangle"].ravel().tolist(), [int(c) for c in triangles.replace("/", "")])
            if depths:
                np.testing.assert_allclose(picture["depth"].ravel(), [int(c) for c in depths.replace("/", "")], rtol=1e-5)


    def test_environments(self):  # glTF-Sample-Viewer#135, hdrv#15, stb#1323; EXR: host/film/test/environment_file_test.cpp
        pixels = bytes((128, 64, 0, 129)) * 32  # (1, 0.5, 0) in a picture of 8 x 4 pixels
        run_lengths = b"".join(bytes((2, 2, 0, 8)) + b"".join(bytes((128 + 8, x)) for x in (128, 64, 0, 129)) for _ in range(4))
        for header, data, expected in (
                ("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n", pixels, (1, .5, 0)),
                 ("#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n", run_lengths, (1, .5, 0)),
                ("#?RADIANCE\n\n-Y 4 +X 8\n", pixels, (1, .5, 0)), ("#?RADIANCE\r\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 4 +X 8\n", pixels, (1, .5, 0)),
                ("#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n", pixels, (.5, .25, 0)),
                ("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+Y 4 +X 8\n", pixels, r"\+Y"),
                 ("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 -X 8\n", pixels, "-X"),
                ("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 4 +X 8\n", pixels, "xyze"), ("RADIANCE\n\n-Y 4 +X 8\n", pixels, "a.hdr")):
            files = {"a.json": json.dumps({"obj": "a.obj", "environment": {"file": "a.hdr"}}), "a.obj": SQUARE + "f 1 2 3 4\n", "a.hdr": header.encode() + data}
            with self.subTest(header), tempfile.TemporaryDirectory() as folder:
                if isinstance(expected, str):
                    with self.assertRaisesRegex(raygate.InputError, expected):
                        load(pathlib.Path(folder), files)
                    continue
                color = load(pathlib.Path(folder), files).render(2, 2, eye=(0, 0, 5), target=(0, 0, 9), integrator="whitted", spp=1)["color"]
                np.testing.assert_allclose(color[..., :3], np.broadcast_to(expected, (2, 2, 3)), rtol=1e-6)

    def test_edges_and_vertices_of_a_cube(self):  # trimesh#1766, mitsuba3#1149, embree#174, #181, #188, fcpw#14
        points = list(itertools.product((0, 1), repeat=3))
        sides = [[p for p in points if p[axis] == value] for axis in range(3) for value in (0, 1)]
        cube = raygate.Scene.of_triangles([t for a, b, c, d in sides for t in ((a, b, d), (a, d, c))])
        places = list(itertools.product((-2, 0, .5, 1, 3), repeat=3))
        rays = [(o, tuple(b - a for a, b in zip(o, to))) for o, to in itertools.product(places, places) if o != to and not all(0 <= x <= 1 for x in o)]
        hits = cube.trace(*map(np.array, zip(*rays)), hits="all", columns="ray")
        counts = np.bincount(hits["ray"], minlength=len(rays))
        for (origin, direction), count in zip(rays, counts):
            axes = [(fractions.Fraction(o), fractions.Fraction(d)) for o, d in zip(origin, direction)]
            slabs = [sorted((-o / d, (1 - o) / d)) for o, d in axes if d]
            near, far = max(0, *(slab[0] for slab in slabs)), min(slab[1] for slab in slabs)
            beside = [o for o, d in axes if not d]  # where the ray is parallel to an axis
            if far < near or not all(0 <= o <= 1 for o in beside):
                self.assertEqual(count, 0, (origin, direction))
            elif far > near and all(0 < o < 1 for o in beside):
                self.assertEqual(count, 2, (origin, direction))
            else:  # along a side, or through an edge
                self.assertIn(count, (0, 2), (origin, direction))

    def test_far_origins_and_equal_places(self):  # pytracer#22, embree#52, trimesh#306, #1097
        scene = raygate.Scene.of_triangles([[(0, 0, 0), (1, 0, 0), (0, 1, 0)]] * 3)
        for distance in (4e2, 1e8, 1e30):
            hits = scene.trace([(.25, .25, distance), (.75, .75, distance)], (0, 0, -1), hits="all")
            self.assertEqual(hits["ray"].tolist(), [0, 0, 0])
            self.assertEqual(hits["triangle"].tolist(), [0, 1, 2])

    def test_kinds_of_arrays(self):  # rdkit#8221, arrow#3648
        scene = raygate.Scene.of_triangles([[(0, 0, 0), (4, 0, 0), (0, 4, 0)]])
        origins = np.random.default_rng(1).random((50, 3)) + (0, 0, 5)
        expected = scene.trace(origins, (0, 0, -1))
        for same in (np.asfortranarray(origins), origins.astype(">f8"), np.repeat(origins, 2, axis=0)[::2],
            np.ndarray((50, 3), buffer=b"x" + origins.tobytes(), offset=1)):
            np.testing.assert_array_equal(scene.trace(same, (0, 0, -1)), expected)

    def test_tables_of_rays(self):  # byte order marks, line ends, comments, quoted rows
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a.obj"
            program = os.environ.get("RAYGATE_TRACE") or pathlib.Path(sys.executable).with_name("raygate-trace")
            path.write_text(SQUARE + "f 1 2 3 4\n")
            for table in ("\ufeffox,oy,oz,dx,dy,dz\n.5,-.5,5,0,0,-1\n", "# rays\r\n.5,-.5,5,0,0,-1\r\n",
                "\ufeff.5,-.5,5,0,0,-1\n", '".5","-.5","5","0","0","-1"\n'):
                run = subprocess.run([program, path, "-", "--columns", "triangle,t", "-q"], input=table.encode(), capture_output=True, check=False)
                self.assertEqual((run.returncode, run.stdout, run.stderr), (0, b"triangle,t\n0,5\n", b""), table)
            (pathlib.Path(folder) / "b.json").write_text('{"instances": [{"model": "a.obj", "places": [[0, 0, 0]]}]}')
            with self.assertRaisesRegex(raygate.InputError, 'found no .*b.obj, expected this model, or "obj" to name another'):
                raygate.Scene(pathlib.Path(folder) / "b.json")
            os.symlink(program, f"{folder}/raygate-trace")
            said = subprocess.run(["raygate-trace", "--help"], env=os.environ | {"PATH": folder}, capture_output=True, text=True, check=True).stdout
            self.assertTrue(said.startswith("Usage: raygate-trace SCENE") and "./trace" not in said, said)


if __name__ == "__main__":
    unittest.main()
