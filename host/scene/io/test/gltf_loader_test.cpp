#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <regex>
#include <set>

#include "host/base/input.h"
#include "host/base/test/temp_folder.h"
#include "host/scene/bounds.h"
#include "host/scene/instances.h"
#include "host/scene/io/scene_loader.h"
#include "host/scene/io/test/binary.h"
#include "host/scene/material_lookup.h"
#include "host/scene/test/tga.h"

namespace raygate {
namespace {

using test::glb, test::square_buffer, test::square_json;

constexpr const char* kOneNode = R"([{"mesh": 0}])";

class LoadGltf : public testing::Test {
 protected:
  [[nodiscard]] Scene load(const std::string& json, const std::string& buffer = square_buffer(),
                           bool keeps_instances = false) const {
    Scene scene = load_gltf(folder_.write("s.glb", glb(json, buffer)));
    if (!keeps_instances) resolve_instances(scene, InstanceMode::kFlatten, "s.glb");
    return scene;
  }
  [[nodiscard]] std::string error(const std::string& json) const {
    return folder_.error_of([&] { (void)load(json); });
  }
  void expect_error(const std::string& json, const std::string& start) const {
    EXPECT_TRUE(error(json).starts_with("s.glb: " + start)) << error(json);
  }

  const TempFolder folder_;
};

glm::dvec3 corner(const Scene& scene, std::size_t triangle, std::size_t k) {
  return scene.origin + glm::dvec3(scene.positions[scene.triangles[triangle].vertices[k]]);
}

/// Expects that a triangle faces +z, by the order of its corners and by its normals.
void expect_front(const Scene& scene, std::size_t triangle) {
  EXPECT_GT(glm::cross(corner(scene, triangle, 1) - corner(scene, triangle, 0),
                       corner(scene, triangle, 2) - corner(scene, triangle, 0))
                .z,
            0.0);
  EXPECT_EQ(scene.normals[scene.triangles[triangle].normals[0]], glm::vec3(0, 0, 1));
}

TEST_F(LoadGltf, ASquare) {
  const Scene scene = load(square_json(kOneNode));
  ASSERT_EQ(scene.triangles.size(), 2u);
  EXPECT_EQ(corner(scene, 0, 1), glm::dvec3(1, 0, 0));
  EXPECT_EQ(corner(scene, 1, 2), glm::dvec3(0, 1, 0));
  EXPECT_EQ(scene.normals[scene.triangles[1].normals[2]], glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.triangles[0].texcoords[0], kNoIndex) << "no texture asks for them";
  EXPECT_EQ(scene.objects, std::vector<std::string>{"square"});
  EXPECT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.up, glm::dvec3(0, 1, 0));
  EXPECT_FALSE(scene.camera);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(LoadGltf, NodesArePutWhereTheirParentsAre) {
  // The parent is doubled, turned by 90 degrees about z and moved far away; its child follows.
  const Scene scene = load(square_json(R"([
      {"name": "parent", "mesh": 0, "scale": [2, 2, 2], "rotation": [0, 0, 0.70710678118654757, 0.70710678118654757],
       "translation": [1000000, 0, 0], "children": [1]},
      {"mesh": 0, "translation": [5, 0, 0]}])"));
  ASSERT_EQ(scene.triangles.size(), 4u);
  const auto near = [](const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::length(a - b), 1e-6) << a.x << " " << a.y << " " << a.z;
  };
  near(corner(scene, 0, 1), {1000000, 2, 0});
  near(corner(scene, 1, 2), {999998, 0, 0});
  near(corner(scene, 2, 0), {1000000, 10, 0});
  EXPECT_EQ(scene.triangles[0].object, 0u);
  EXPECT_EQ(scene.triangles[2].object, 1u);
  EXPECT_EQ(scene.objects[0], "parent");
}

TEST_F(LoadGltf, MeshesOfSeveralNodesAreKeptOnce) {
  const std::string json = square_json(R"([{"children": [1, 2, 3]},
      {"name": "one", "mesh": 0, "translation": [3000000, 0, 0]},
      {"name": "two", "mesh": 0, "translation": [3000002, 0.25, 0], "scale": [-1, 2, 1]},
      {"name": "three", "mesh": 0, "scale": [1, 1, 1], "translation": [3000000, 5, 1]}])");
  const Scene kept = load(json, square_buffer(), true);
  EXPECT_TRUE(kept.triangles.empty());
  ASSERT_EQ(kept.instances.size(), 3u);
  EXPECT_EQ(kept.meshes.size(), 2u) << "one is mirrored";
  const Scene written = load(json);
  EXPECT_TRUE(written.instances.empty());
  EXPECT_EQ(written.objects, (std::vector<std::string>{"one", "two", "three"}));
  ASSERT_EQ(written.triangles.size(), 6u);
  EXPECT_EQ(kept.origin, written.origin);
  std::size_t number = 0;
  for_each_face(kept, [&](const Corners& corners, const Triangle&) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(corners[k], written.vertex(written.triangles[number].vertices[k]));
    }
    EXPECT_EQ(written.triangles[number].object, number / 2);
    expect_front(written, number++);
  });
  EXPECT_EQ(corner(written, 1, 2), glm::dvec3(3000000, 1, 0));
  EXPECT_EQ(corner(written, 0, 1), glm::dvec3(3000001, 0, 0));
  expect_error(
      square_json(R"([{"mesh": 0, "children": [1]}, {"mesh": 0, "translation": [0, 0, 1e39]}])"),
      "a vertex is beyond the range of float");
}

TEST_F(LoadGltf, InstancesOfAMeshWithoutAreaTakeNoNumbers) {
  std::string json = square_json(
      R"([{"children": [1, 2, 3, 4]}, {"mesh": 1}, {"mesh": 1}, {"mesh": 0}, {"mesh": 0}])");
  const std::string_view end = "],\n      \"accessors\"";
  json.insert(json.find(end),
              R"(, {"primitives": [{"attributes": {"POSITION": 1}, "indices": 3}]})");
  for (const bool keeps : {false, true}) {
    const Scene scene = load(json, square_buffer(), keeps);
    EXPECT_EQ(triangle_count(scene), 4u);
    EXPECT_EQ(scene.instances.size(), keeps ? 2u : 0u);
    EXPECT_EQ(object_at(scene, keeps ? FaceRef{0, 0} : FaceRef{kNoIndex, 0}), 2u)
        << "objects are numbered by nodes";
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("face of zero area, left out"), std::string::npos);
  }
}

TEST_F(LoadGltf, AMirroredNodeKeepsItsFront) {
  const Scene scene = load(square_json(R"([{"mesh": 0, "scale": [-1, 1, 1]}])"));
  expect_front(scene, 0);
  const Scene file = load(square_json(R"([{"mesh": 0}])"));
  for (int k = 0; k < 3; ++k) {  // the file's corners, in reverse order
    const glm::dvec3 mirrored = corner(scene, 0, k) * glm::dvec3(-1, 1, 1);
    EXPECT_EQ(mirrored, corner(file, 0, 2 - k)) << k;
  }
  const Scene inside_out = load(square_json(R"([{"mesh": 0, "scale": [-1, -1, -1]}])"));
  EXPECT_EQ(inside_out.normals[inside_out.triangles[0].normals[0]], glm::vec3(0, 0, -1));
}

TEST_F(LoadGltf, CamerasAndLights) {
  const Scene scene = load(square_json(
      R"([{"mesh": 0, "children": [1, 2, 3]}, {"camera": 0, "translation": [0.5, 0.5, 4]},
          {"translation": [1, 2, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}},
          {"extensions": {"KHR_lights_punctual": {"light": 1}}, "children": [4]},
          {"extensions": {"KHR_lights_punctual": {"light": 2}}}])",
      R"(, "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}],
         "extensionsUsed": ["KHR_lights_punctual"],
         "extensions": {"KHR_lights_punctual": {"lights": [
           {"type": "point", "color": [1, 0.5, 0], "intensity": 1366},
           {"type": "directional", "intensity": 683},
           {"type": "spot", "intensity": 683,
            "spot": {"innerConeAngle": 0.5, "outerConeAngle": 1.5707963267948966}}]}})"));
  ASSERT_TRUE(scene.camera);
  EXPECT_EQ(scene.camera->eye, glm::dvec3(0.5, 0.5, 4));
  EXPECT_EQ(scene.camera->target, glm::dvec3(0.5, 0.5, 0)) << "among the scene";
  EXPECT_EQ(scene.camera->up, glm::dvec3(0, 1, 0));
  EXPECT_NEAR(*scene.camera->fov, 0.5 * 180 / 3.14159265358979, 1e-9);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[0].intensity, glm::dvec3(2, 1, 0));
  EXPECT_EQ(scene.origin + glm::dvec3(scene.lights[0].position), glm::dvec3(1, 2, 3));
  EXPECT_FALSE(scene.lights[0].spot);
  ASSERT_TRUE(scene.lights[1].spot);
  EXPECT_EQ(scene.lights[1].spot->axis, glm::dvec3(0, 0, -1));
  EXPECT_NEAR(scene.lights[1].spot->inner, 0.5 * 180 / 3.14159265358979, 1e-9);
  EXPECT_EQ(scene.lights[1].spot->outer, 90.0);
  ASSERT_EQ(scene.directional_lights.size(), 1u);
  EXPECT_EQ(scene.directional_lights[0].direction, glm::dvec3(0, 0, -1));
  EXPECT_EQ(scene.directional_lights[0].irradiance, glm::vec3(1));
}

// An image's height shows 2 ymag, whatever the target's distance.
TEST_F(LoadGltf, OrthographicCameras) {
  const auto with_size = [](const std::string& ymag) {
    return square_json(
        R"([{"mesh": 0, "children": [1]}, {"camera": 0, "translation": [0.5, 0.5, 4]}])",
        R"(, "cameras": [{"type": "orthographic", "orthographic":
                           {"xmag": 1, "ymag": )" +
            ymag + R"(, "zfar": 9, "znear": 0}}])");
  };
  const Scene scene = load(with_size("3"));
  ASSERT_TRUE(scene.camera);
  EXPECT_EQ(scene.camera->lens.projection, Projection::kOrthographic);
  EXPECT_EQ(scene.camera->target, glm::dvec3(0.5, 0.5, 0));
  EXPECT_NEAR(4.0 * std::tan(*scene.camera->fov / 360.0 * std::numbers::pi), 3.0, 1e-12);
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_FALSE(load(with_size("0")).camera) << "left out, with a warning";
}

TEST_F(LoadGltf, Materials) {
  const auto material = [&](const std::string& text) {
    return load(square_json(kOneNode, R"(, "materials": [)" + text + "]", R"(, "material": 0)"))
        .materials.at(0);
  };
  const Material matte = material(
      R"({"name": "m", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1], "metallicFactor": 0}})");
  EXPECT_EQ(matte.name, "m");
  EXPECT_EQ(matte.diffuse, glm::vec3(0.5f, 0.25f, 1.0f));
  EXPECT_EQ(matte.emission, glm::vec3(0.0f));
  ASSERT_TRUE(matte.metallic_roughness);
  EXPECT_EQ(matte.metallic_roughness->metallic, 0.0f);
  EXPECT_EQ(matte.metallic_roughness->roughness, 1.0f);
  EXPECT_EQ(matte.opacity, 1.0f);
  const Material plastic =
      material(R"({"pbrMetallicRoughness": {"metallicFactor": 0.25, "roughnessFactor": 0.5}})");
  EXPECT_EQ(plastic.metallic_roughness->metallic, 0.25f);
  EXPECT_EQ(plastic.metallic_roughness->roughness, 0.5f);
  EXPECT_EQ(plastic.refraction_index, 1.5f);
  const Material window = material(
      R"({"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.25]}})");
  EXPECT_EQ(window.opacity, 0.25f);
  const Material hole = material(
      R"({"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.25]}})");
  EXPECT_EQ(hole.opacity, 0.0f);
  const Material unlit = material(R"({"extensions": {"KHR_materials_unlit": {}}})");
  EXPECT_EQ(unlit.illumination_model, 0);
  EXPECT_FALSE(unlit.metallic_roughness);
  const Material emitter = material(
      R"({"emissiveFactor": [1, 0.5, 0], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}})");
  EXPECT_EQ(emitter.emission, glm::vec3(4, 2, 0));
  const Material glass = material(
      R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.3}}})");
  EXPECT_EQ(glass.metallic_roughness->transmission, 1.0f);
  EXPECT_EQ(glass.refraction_index, 1.3f);
  const Material dull = material(
      R"({"extensions": {"KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1, 2, 0]}}})");
  EXPECT_EQ(dull.metallic_roughness->specular, 0.5f);
  EXPECT_EQ(dull.metallic_roughness->specular_color, glm::vec3(1, 2, 0));
}

/// Returns a TGA of one row: an opaque red pixel, then a nearly clear blue one.
std::string half_clear() {
  std::string bytes(18, '\0');
  bytes[2] = 2;
  bytes[12] = 2;
  bytes[14] = 1;
  bytes[16] = 32;
  bytes[17] = 8;
  return bytes + std::string("\x00\x00\xFF\xFF\xFF\x00\x00\x10", 8);
}

class LoadGltfPicture : public LoadGltf {
 protected:
  /// Returns a square with one material and a picture: red and opaque on the left, blue and nearly
  /// clear on the right.
  [[nodiscard]] Scene with_picture(const std::string& material, const std::string& texture = "",
                                   const std::string& more = "",
                                   const LoadOptions& options = {}) const {
    std::string json = square_json(kOneNode,
                                   R"(, "materials": [{)" + material + R"(}], "textures": [{)" +
                                       texture + R"("source": 0}],
         "images": [{"bufferView": 4, "mimeType": "image/tga"}])" +
                                       more,
                                   R"(, "material": 0)");
    const std::string last = R"({"buffer": 0, "byteOffset": 128, "byteLength": 12})";
    json.replace(json.find(last), last.size(),
                 last + R"(, {"buffer": 0, "byteOffset": 140, "byteLength": 26})");
    json.replace(json.find(R"("byteLength": 140)"), 17, R"("byteLength": 166)");
    return load_gltf(folder_.write("s.glb", glb(json, square_buffer() + half_clear())), options);
  }
};

TEST_F(LoadGltfPicture, TexturesOfRoughnessNormalsAndOpacity) {
  const std::string with = R"("alphaMode": "MASK", "alphaCutoff": 0.25,
      "normalTexture": {"index": 0, "scale": 0.5},
      "emissiveTexture": {"index": 0}, "emissiveFactor": [1, 0.5, 0],
      "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 1, 1, 0.5],
                               "metallicRoughnessTexture": {"index": 0}})";
  const Scene scene = with_picture(with, R"("sampler": 0, )", R"(, "samplers": [
      {"wrapS": 33648, "wrapT": 33071, "magFilter": 9728}])");
  ASSERT_EQ(scene.textures.size(), 2u) << "colour and opacity of one picture";
  const Material& material = scene.materials[0];
  EXPECT_EQ(material.diffuse_map.texture, 0u);
  EXPECT_EQ(material.diffuse_map.mapping.sampling.v, Wrap::kClamp);
  EXPECT_TRUE(material.diffuse_map.mapping.sampling.is_nearest);
  EXPECT_EQ(material.normal_map.texture, 0u);
  EXPECT_EQ(material.normal_scale, 0.5f);
  EXPECT_EQ(material.emission_map.texture, 0u);
  EXPECT_EQ(material.emission, glm::vec3(1.0f, 0.5f, 0.0f)) << "times the texture";
  EXPECT_EQ(material.metallic_roughness->roughness_map.texture, 0u);
  EXPECT_EQ(material.opacity_map.texture, 1u);
  EXPECT_EQ(material.opacity_cutoff, 0.5f) << "of the texture alone";
  EXPECT_EQ(scene.textures[1].min_code(), 16 / 255.0);
  const glm::dvec3 left(0.75, 0.0, 0.25), right(0.25, 0.5, 0.25);
  EXPECT_FALSE(is_masked_out(scene, scene.triangles[0], left));
  EXPECT_TRUE(is_masked_out(scene, scene.triangles[0], right));
  EXPECT_TRUE(scene.warnings.empty());
  const Scene bare = with_picture(with, "", "", {.textures = false});
  EXPECT_TRUE(bare.textures.empty());
  EXPECT_EQ(bare.materials[0].opacity_map.texture, kNoIndex);
  EXPECT_EQ(bare.triangles.size(), scene.triangles.size());
}

TEST_F(LoadGltfPicture, TexturesOfExtensions) {
  const Scene scene = with_picture(R"("extensions": {
      "KHR_materials_transmission": {"transmissionFactor": 0.75, "transmissionTexture": {"index": 0}},
      "KHR_materials_specular": {"specularFactor": 0.5, "specularTexture": {"index": 0},
        "specularColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [1, 0.5]}}}}})");
  const MetallicRoughness& shares = *scene.materials[0].metallic_roughness;
  EXPECT_EQ(shares.transmission, 0.75f);
  EXPECT_EQ(shares.specular_color_map.mapping.scale, glm::vec2(1.0f, 0.5f));
  ASSERT_EQ(scene.textures.size(), 2u) << "colours, and opacity";
  const auto left = metallic_roughness_factors_at(scene, scene.triangles[0], {0.75, 0.0, 0.25});
  const auto right = metallic_roughness_factors_at(scene, scene.triangles[0], {0.25, 0.5, 0.25});
  EXPECT_EQ(left.transmission, 1.0f) << "red";
  EXPECT_EQ(left.specular, 1.0f) << "opacity";
  EXPECT_EQ(left.specular_color, glm::vec3(1, 0, 0));
  EXPECT_EQ(right.transmission, 0.0f);
  EXPECT_NEAR(right.specular, 16 / 255.0, 1e-6);
  EXPECT_EQ(right.specular_color, glm::vec3(0, 0, 1));
  EXPECT_EQ(right.roughness, 1.0f) << "there is no texture of it";
  EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(LoadGltfPicture, BlendedOpacity) {
  const Scene scene = with_picture(R"("alphaMode": "BLEND", "pbrMetallicRoughness": {
      "baseColorTexture": {"index": 0}, "baseColorFactor": [1, 1, 1, 0.5]})");
  EXPECT_TRUE(scene.materials[0].opacity_blends);
  EXPECT_EQ(scene.materials[0].opacity, 0.5f);
  EXPECT_NEAR(opacity_factor_at(scene, scene.triangles[0], {0.25, 0.5, 0.25}), 16 / 255.0, 1e-6);
  EXPECT_FALSE(is_masked_out(scene, scene.triangles[0], {0.25, 0.5, 0.25}));
  EXPECT_TRUE(scene.warnings.empty());
}

/// An attribute of the square, of four floats for each vertex.
using Attribute = std::pair<const char*, std::array<float, 16>>;

/// Adds attributes to the JSON of the square, and their bytes to its buffer.
void add(const std::vector<Attribute>& attributes, std::string& json, std::string& buffer) {
  const auto insert = [&](const char* before, const std::string& text) {
    json.insert(json.find(before), text);
  };
  int number = 4;
  for (const auto& [name, numbers] : attributes) {
    insert("}, \"indices\"", ", \"" + std::string(name) + "\": " + std::to_string(number));
    insert("],\n      \"bufferViews\"",
           R"(, {"bufferView": )" + std::to_string(number++) +
               R"(, "componentType": 5126, "count": 4, "type": "VEC4"})");
    insert("],\n      \"buffers\"", R"(, {"buffer": 0, "byteLength": 64, "byteOffset": )" +
                                        std::to_string(buffer.size()) + "}");
    for (const float number_of : numbers) buffer += test::bytes_of(number_of);
  }
  json.replace(json.find(R"("byteLength": 140})"), 17,
               R"("byteLength": )" + std::to_string(buffer.size()));
}

TEST_F(LoadGltf, ExtensionsInTheSourceAreRead) {
  const std::filesystem::path source = std::filesystem::path(RAYGATE_SCENES) / "../host/scene/io";
  std::set<std::string> names;
  for (const char* file : {"gltf_loader.cpp", "gltf_materials.h"}) {
    const std::string text = read_file(source / file);
    const std::regex name("\"((KHR|EXT)_\\w+)\"");
    for (std::sregex_iterator at(text.begin(), text.end(), name), end; at != end; ++at) {
      names.insert((*at)[1]);
    }
  }
  EXPECT_GE(names.size(), 7u);
  for (const std::string& name : names) {
    const std::string list = "[\"" + name + "\"]";
    const Scene scene = load(square_json(
        kOneNode, ", \"extensionsUsed\": " + list + ", \"extensionsRequired\": " + list));
    EXPECT_EQ(scene.warnings, std::vector<std::string>()) << name;
  }
}

TEST_F(LoadGltf, SkinsAtRest) {
  std::string buffer = square_buffer();
  std::string json = square_json(
      R"([{"children": [1, 2]}, {"mesh": 0, "skin": 0, "translation": [7, 7, 7]},
          {"translation": [0, 0, 4], "scale": [2, 2, 2], "children": [3]}, {"translation": [1, 0, 0]}])",
      R"(, "skins": [{"joints": [2, 3], "inverseBindMatrices": 6}])");
  add({{"JOINTS_0", {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1}},
       {"WEIGHTS_0", {1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0, 1}},
       {"_BIND", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}},
      json, buffer);
  json.replace(json.find(R"(, "_BIND": 6)"), 12, "");
  const Scene scene = load(json, buffer);
  ASSERT_EQ(scene.triangles.size(), 2u);
  EXPECT_EQ(corner(scene, 0, 0), glm::dvec3(0, 0, 4)) << "by the first joint, not by the node";
  EXPECT_EQ(corner(scene, 0, 1), glm::dvec3(4, 0, 4)) << "by the second one";
  EXPECT_EQ(corner(scene, 0, 2), glm::dvec3(3, 2, 4)) << "by both";
}

TEST_F(LoadGltf, OpacityOfVertices) {
  for (const auto& [mode, opacity, is_hole] :
       {std::tuple{"OPAQUE", 1.0f, false}, {"BLEND", 0.25f, false}, {"MASK", 1.0f, true}}) {
    std::string buffer = square_buffer();
    std::string json =
        square_json(kOneNode, R"(, "materials": [{"alphaMode": ")" + std::string(mode) + "\"}]",
                    R"(, "material": 0)");
    add({{"COLOR_0", {1, 1, 1, 0, 1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1}}}, json, buffer);
    const Scene scene = load(json, buffer);
    const Triangle& face = scene.triangles[0];
    EXPECT_EQ(opacity_factor_at(scene, face, {0.25, 0.5, 0.25}), opacity) << mode;
    EXPECT_EQ(is_masked_out(scene, face, {0.25, 0.5, 0.25}), is_hole) << mode;
    EXPECT_FALSE(is_masked_out(scene, face, {0.0, 0.25, 0.75})) << mode;
    EXPECT_EQ(vertex_color_at(scene.colors, face, {0.25, 0.5, 0.25}), glm::vec3(1.0f));
  }
}

TEST_F(LoadGltf, Tangents) {
  std::string buffer = square_buffer();
  std::string json = square_json(
      R"([{"children": [1, 2, 3]}, {"mesh": 0}, {"mesh": 0, "rotation": [0, 0, 1, 0]},
          {"mesh": 0, "scale": [1, -2, 1]}])",
      R"(, "materials": [{"normalTexture": {"index": 0}}], "textures": [{"source": 0}],
         "images": [{"uri": "right.tga"}])",
      R"(, "material": 0)");
  add({{"TANGENT", {0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1}}}, json, buffer);
  (void)folder_.write("right.tga", test::tga(1, 1, {{255, 255, 128}}));
  for (const bool keeps : {false, true}) {
    const Scene scene = load(json, buffer, keeps);
    int number = 0;
    for (const glm::vec3& expected :
         {glm::vec3(-1, 1, 0), glm::vec3(1, -1, 0), glm::vec3(-1, -1, 0)}) {
      const Instance* const instance = keeps ? &scene.instances[number] : nullptr;
      const Triangle& face =
          keeps ? scene.meshes[instance->mesh].triangles[0] : scene.triangles[2 * number];
      const glm::vec3 normal =
          mapped_normal(scene, face, {glm::vec3(0, 0, 0), {1, 0, 0}, {1, 1, 0}}, instance,
                        {0.25, 0.5, 0.25}, {0, 0, 1});
      EXPECT_LT(glm::length(normal - glm::normalize(expected)), 0.01f)
          << number << normal.x << normal.y;
      ++number;
    }
  }
}

TEST_F(LoadGltf, TwoSetsOfTextureCoordinates) {
  std::string buffer = square_buffer();
  std::string json = square_json(
      R"([{"children": [1, 2]}, {"mesh": 0}, {"mesh": 0}])",
      R"(, "materials": [{"emissiveTexture": {"index": 0, "texCoord": 1}, "emissiveFactor": [1, 1, 1],
           "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
         "textures": [{"source": 0}], "images": [{"uri": "two.tga"}])",
      R"(, "material": 0)");
  add({{"TEXCOORD_1", {0.75, 0.5, 0, 0, 0.75, 0.5, 0, 0, 0.75, 0.5, 0, 0, 0.75, 0.5}}}, json,
      buffer);
  (void)folder_.write("two.tga", test::tga(2, 1, {{255, 0, 0}, {0, 0, 255}}));
  const Scene scene = load(json, buffer);
  EXPECT_EQ(scene.warnings, std::vector<std::string>());
  ASSERT_EQ(scene.triangles.size(), 4u);
  for (const std::size_t face : {1u, 3u}) {
    const Triangle& triangle = scene.triangles[face];
    EXPECT_EQ(diffuse_at(scene, triangle, {0.375, 0.25, 0.375}), glm::vec3(1, 0, 0));
    EXPECT_EQ(emission_factor_at(scene, triangle, {0.375, 0.25, 0.375}), glm::vec3(0, 0, 1));
  }
}

TEST_F(LoadGltf, UnknownAttributesAreWarnedOf) {
  std::string json = square_json(kOneNode);
  json.insert(json.find("\"NORMAL\""), R"("COLOR_1": 0, )");
  const Scene scene = load(json);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_TRUE(scene.warnings[0].ends_with("the attribute 'COLOR_1' is not read"));
}

TEST_F(LoadGltf, WhatIsRefused) {
  expect_error("{}", "not a glTF 2.0 file that can be read: ");
  expect_error(square_json(R"([{"mesh": 1}])"), "mesh 1, but the file has 1");
  expect_error(square_json(R"([{"mesh": 0, "children": [0]}])"), "node 0 has two parents");
  expect_error(square_json(R"([{"children": [1, 1]}, {"mesh": 0}])"), "node 1 has two parents");
  expect_error(square_json(R"([{"translation": [1, 2, 3]}])"), "no faces");
  expect_error(square_json(R"([{"mesh": 0, "scale": [1e300, 1, 1]}])"), "a vertex is beyond");
  expect_error(square_json(kOneNode, R"(, "extensionsRequired": ["KHR_draco_mesh_compression"])"),
               "found the extension 'KHR_draco_mesh_compression', which is not read");
  for (const char* extension : {"EXT_meshopt_compression", "KHR_draco_mesh_compression"}) {
    const std::string used = std::string(R"(, "extensionsUsed": [")") + extension + "\"]";
    std::string broken = square_json(kOneNode, used);
    broken.replace(broken.find(R"("buffer": 0)"), 11, R"("buffre": 0)");
    expect_error(broken, "found the extension '" + std::string(extension) +
                             "', which is not read; expected a file without compression");
  }
  EXPECT_TRUE(error("{\n, }").starts_with("s.glb:2: not JSON: syntax error"));
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  EXPECT_EQ(error(square_json(kOneNode, R"(, "extras": )" + deep)), "(read)");
  std::string json = square_json(kOneNode);
  json.replace(json.find(R"("count": 6)"), 10, R"("count": 9)");
  expect_error(json, "accessor 3 (indices): beyond its buffer");
  json = square_json(kOneNode);
  json.replace(json.find(R"("count": 4)"), 10, R"("count": 3)");
  expect_error(json, "index 3 in a primitive of 3 vertices");
  json = square_json(kOneNode);
  json.replace(json.find("\"2.0\""), 5, "\"1.0\"");
  expect_error(json, "glTF version '1.0'");
}

TEST_F(LoadGltf, MeshesOfManySkinsAreBounded) {
  std::string primitives, nodes = "[{\"children\": [";
  for (int i = 1; i <= 4000; ++i) nodes.append(i > 1 ? "," : "").append(std::to_string(i));
  nodes += "]}";
  for (int i = 1; i <= 4000; ++i) nodes += ",{\"mesh\":0,\"skin\":0}";
  std::string json = square_json(nodes + "]");
  const std::string one =
      json.substr(json.find("{\"attributes"), json.find("}]}]") + 1 - json.find("{\"attributes"));
  std::string many;
  for (int i = 0; i < 1000; ++i) many += one + ",";
  json.insert(json.find("{\"attributes"), many);
  expect_error(json, "more than ");
}

}  // namespace
}  // namespace raygate
