// Files as other programs write them: what is optional and bad costs a warning, not the model. More
// of them are in host/python/test/reports_test.py.
#include <gtest/gtest.h>

#include <algorithm>

#include "host/base/input.h"
#include "host/base/test/temp_folder.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/test/binary.h"
#include "host/scene/test/tga.h"

namespace raygate {
namespace {

using namespace std::string_literals;

/// Returns the counts of triangles, of those with normals and with texture coordinates, and of
/// textures.
std::string counts(const Scene& scene) {
  const auto count = [&](std::array<std::uint32_t, 3> Triangle::*indices) {
    return std::to_string(std::ranges::count_if(
        scene.triangles, [&](const Triangle& t) { return (t.*indices)[0] != kNoIndex; }));
  };
  return std::to_string(scene.triangles.size()) + " " + count(&Triangle::normals) + " " +
         count(&Triangle::texcoords) + " " + std::to_string(scene.textures.size());
}

struct ForeignFile {
  const char* name;
  const char* ending;
  std::string bytes;
  std::string counts;
  std::string warning;  ///< part of the first one; empty: there is none
};

class LoadForeign : public testing::TestWithParam<ForeignFile> {};

TEST_P(LoadForeign, IsRead) {
  const TempFolder folder;
  (void)folder.write("maps/pic.tga", test::tga(1, 1, {{255, 0, 0}}));
  (void)folder.write("empty.png", "");
  const ForeignFile& with = GetParam();
  (void)folder.write("beside.tga", test::tga(1, 1, {{255, 0, 0}}));
  for (const auto& [name, map] : {std::pair{"second.mtl", "none.png"},
                                  {"my colours.mtl", "\"maps/pic.tga\""},
                                  {"inner.mtl", "maps\\PIC.tga"}}) {
    (void)folder.write(name, "newmtl m\nmap_Kd "s + map + "\n");
  }
  const Scene scene = load_scene(folder.write("s"s + with.ending, with.bytes));
  EXPECT_EQ(counts(scene), with.counts);
  const std::string first = scene.warnings.empty() ? "" : scene.warnings[0];
  EXPECT_EQ(first.empty(), with.warning.empty()) << first;
  EXPECT_NE(first.find(with.warning), std::string::npos) << first;
  EXPECT_LT(first.size(), folder.path().string().size() + 200) << "no data URI";
}

/// Two triangles that share their corners, with normals and texture coordinates.
std::string obj(const std::string& faces, const std::string& more = "") {
  return "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\n" + more + faces +
         "f 1/1/1 2/2/1 3/3/1\n";
}

std::string textured(const std::string& library) {
  return obj("mtllib " + library + "\nusemtl m\n");
}

/// A square; its buffer holds a NaN in place of the number at `place`, if any.
std::string gltf(const std::string& more, const std::string& nodes = R"([{"mesh": 0}])",
                 std::size_t nan_at = 0, const std::string& material = R"(, "material": 0)") {
  std::string buffer = test::square_buffer();
  if (nan_at > 0) buffer.replace(nan_at, 4, test::bytes_of(std::nanf("")));
  return test::glb(test::square_json(nodes, more, material), buffer);
}

/// Returns the file with one part replaced, which changes its JSON's length.
std::string with(const std::string& glb, const std::string& part, const std::string& instead) {
  constexpr std::size_t kJson = 20;
  const std::size_t size = number_at<std::uint32_t>(glb.data() + 12);
  std::string json = glb.substr(kJson, size);
  json.replace(json.find(part), part.size(), instead);
  return test::glb(json, glb.substr(kJson + size + 8));
}

std::string with_image(const std::string& image) {
  return gltf(R"(, "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
      "textures": [{"source": 0}], "images": [)" +
              image + "]");
}

std::string with_spot(const std::string& light) {
  return gltf(R"(, "extensionsUsed": ["KHR_lights_punctual"],
      "extensions": {"KHR_lights_punctual": {"lights": [)" +
                  light + "]}}",
              R"([{"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}])", 0, "");
}

/// A triangle with a texture, two properties of its vertices and, unless that is empty, a list of
/// six numbers of its face.
std::string ply(const std::string& u, const std::string& v, const std::string& list) {
  return "ply\nformat ascii 1.0\ncomment TextureFile maps/a pic.tga\nelement vertex 3\n"
         "property float x\nproperty float y\nproperty float z\nproperty float " +
         u + "\nproperty float " + v +
         "\nelement face 1\nproperty list uchar int vertex_indices\n" +
         (list.empty() ? "" : "property list uchar float " + list + "\n") +
         "end_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2" +
         (list.empty() ? "" : " 6 0 0 1 0 0 1") + "\n";
}

INSTANTIATE_TEST_SUITE_P(
    , LoadForeign,
    testing::Values(
        ForeignFile{"NoNormalOfOneCorner", ".obj", obj("f 1/1/1 2/2 3/3/1\n"), "2 1 2 0",
                    ":8: face corner without a normal"},
        ForeignFile{"TexcoordZero", ".obj", obj("f 1/0/1 2/0/1 3/0/1\n"), "2 2 1 0",
                    ":8: face corner without texture coordinates"},
        ForeignFile{"NormalOutOfRange", ".obj", obj("f 1/1/2 2/2/1 3/3/1\n"), "2 1 2 0",
                    ":8: face corner without a normal"},
        ForeignFile{"NanColourUsed", ".obj", obj("f 1 2 4\n", "v 0 0 1 1 nan x\n"), "2 1 1 0",
                    ": 1 colours of vertices that are not finite numbers, taken as white"},
        ForeignFile{"TexturePly", ".ply", ply("s", "v", ""), "1 0 0 0",
                    ": not read: texture 'maps/a pic.tga', 's' of vertex, 'v' of vertex"},
        ForeignFile{"NanNormalGltf", ".glb", gltf("", R"([{"mesh": 0}])", 48, ""), "2 0 0 0",
                    "normal without a direction"},
        ForeignFile{"NanTexcoordGltf", ".glb",
                    gltf(R"(, "materials": [{"normalTexture": {"index": 0}}], "textures": [{}])",
                         R"([{"mesh": 0}])", 104),
                    "2 2 1 0", "a texture without a PNG"},
        ForeignFile{"WebpGltf", ".glb",
                    with_image(R"({"bufferView": 0, "mimeType": "image/webp"})"), "2 2 2 0",
                    "image 0: not a PNG, JPEG, TGA or BMP picture"},
        ForeignFile{"ImageOfNothing", ".glb", with_image("{}"), "2 2 2 0",
                    "image 0 has no picture, its material is plain instead"},
        ForeignFile{"ImageWithoutData", ".glb", with_image(R"({"uri": "data:image/png;base64,"})"),
                    "2 2 2 0", "image 0 has no picture"},
        ForeignFile{"ImageOfAnEmptyFile", ".glb", with_image(R"({"uri": "empty.png"})"), "2 2 2 0",
                    "empty.png: the file is empty, its material is plain instead"},
        ForeignFile{"ImageInNoBufferView", ".glb", with_image(R"({"bufferView": 9})"), "2 2 2 0",
                    "buffer view 9, but the file has 4, its material is plain instead"},
        ForeignFile{"ImageBeyondItsBuffer", ".glb",
                    with(with_image(R"({"bufferView": 4})"), R"("byteLength": 12})",
                         R"("byteLength": 12}, {"buffer": 0, "byteLength": 9999999})"),
                    "2 2 2 0", "image 0: beyond its buffer"},
        ForeignFile{"MaterialOfOtherLengths", ".glb",
                    gltf(R"(, "materials": [{"emissiveFactor": [1], "normalTexture": {}}])"),
                    "2 2 0 0", "'normalTexture' of a material is not as glTF has it, left out"},
        ForeignFile{
            "OcclusionTexture", ".glb",
            gltf(R"(, "materials": [{"occlusionTexture": {"index": 0}}], "textures": [{}])"),
            "2 2 0 0", "occlusionTexture is not read"},
        ForeignFile{"TexcoordSetOfNoInteger", ".glb",
                    with(with_image(R"({"uri": "beside.tga"})"), R"({"index": 0})",
                         R"({"index": 0, "extensions": {"KHR_texture_transform":
                             {"texCoord": 1e300}}})"),
                    "2 2 0 1", ""},
        ForeignFile{"TexcoordSetBelowZero", ".glb",
                    with(with_image(R"({"uri": "beside.tga"})"), R"({"index": 0})",
                         R"({"index": 0, "texCoord": -7})"),
                    "2 2 0 1", ""},
        ForeignFile{"SparseNormalsOfNoPlace", ".glb",
                    with(gltf("", R"([{"mesh": 0}])", 0, ""), R"({"bufferView": 1,)",
                         R"({"sparse": {"count": 1, "indices": {"componentType": 5123},
                             "values": {"bufferView": 1}},)"),
                    "2 0 0 0",
                    "accessor 1 (NORMAL): found no buffer view, expected its number, left out"},
        ForeignFile{"CameraWithoutNumbers", ".glb",
                    gltf(R"(, "cameras": [{"type": "perspective"}])",
                         R"([{"mesh": 0, "camera": 0}])", 0, ""),
                    "2 2 0 0", "a camera's yfov: expected more than 0 and less than pi, left out"},
        ForeignFile{"SkinWithoutJoints", ".glb",
                    gltf(R"(, "skins": [{}])", R"([{"mesh": 0, "skin": 0}])", 0, ""), "2 2 0 0",
                    "a skin without joints is left out"},
        ForeignFile{"AnimationOfNothing", ".glb",
                    gltf(R"(, "animations": [{"samplers": [{}]}])", R"([{"mesh": 0}])", 0, ""),
                    "2 2 0 0", "animations are not read"},
        ForeignFile{"NoSuchTextureGltf", ".glb",
                    gltf(R"(, "materials": [{"normalTexture": {"index": 3}}])"), "2 2 2 0",
                    "texture 3, but the file has 0, its material is plain instead"},
        ForeignFile{"NoSuchCamera", ".glb", gltf("", R"([{"mesh": 0, "camera": 2}])", 0, ""),
                    "2 2 0 0", "camera 2, but the file has 0, left out"},
        ForeignFile{"SpotWithoutSpot", ".glb", with_spot(R"({"type": "spot"})"), "2 2 0 0",
                    "a spot light without 'spot' has the usual cone"},
        ForeignFile{"LightOfNoType", ".glb", with_spot("{}"), "2 2 0 0",
                    "found a light of the type '', expected directional, point or spot, left out"},
        ForeignFile{"NegativeLight", ".glb", with_spot(R"({"type": "point", "intensity": -1})"),
                    "2 2 0 0", "a light's intensity: expected no negative"},
        ForeignFile{"TextureInOtherCase", ".obj", textured("inner.mtl"), "1 1 1 1",
                    "'maps\\PIC.tga' is missing, "},
        ForeignFile{"NamesInQuotes", ".obj", textured("\"my colours.mtl\" \"second.mtl\""),
                    "1 1 1 1", ""},
        ForeignFile{"ImageInOtherCase", ".glb",
                    with_image(R"({"uri": "C:%5CTextures%5CBeside.tga"})"), "2 2 2 1",
                    "'C:\\Textures\\Beside.tga' is missing, "},
        ForeignFile{"ImageMissing", ".glb", with_image(R"({"uri": "none.png"})"), "2 2 2 0",
                    "the texture 'none.png' is missing"},
        ForeignFile{"LongDataOfNoKind", ".glb",
                    with_image(R"({"uri": "data:image/x-png,)" + std::string(9000, 'A') + "\"}"),
                    "2 2 2 0", "the texture 'data:image/x-png,AAA"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace raygate
