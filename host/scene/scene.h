// Scene: triangles, materials, textures, lights and instances, recentred on an origin.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/name_list.h"
#include "host/scene/texture.h"

namespace raygate {

/// No normal, texture coordinate or material stands behind this index.
inline constexpr std::uint32_t kNoIndex = std::numeric_limits<std::uint32_t>::max();

/// Where on a texture a surface's texture coordinates lead: scale * (u, v), turned, plus offset.
struct TextureMapping {
  glm::vec2 scale{1.0f};       ///< -s
  glm::vec2 offset{0.0f};      ///< -o
  Sampling sampling;           ///< -clamp on: Wrap::kClamp
  glm::vec2 turn{1.0f, 0.0f};  ///< cosine and sine of a counter-clockwise rotation
  bool is_second = false;      ///< it is of Scene::second_texcoords
};

/// A texture that a material names, and where it lies.
struct MaterialMap {
  std::string file;  ///< joined to the naming file's folder; empty: none, or embedded
  TextureMapping mapping;
  std::uint32_t texture = kNoIndex;  ///< index into Scene::textures
};

/// The metallic-roughness model of glTF 2.0 (its appendix B), in place of the lobes of `illum`. The
/// base colour is Material::diffuse and its texture; what is not metallic reflects by
/// Material::refraction_index, which counts as 1.5 where it is 1.
struct MetallicRoughness {
  float metallic = 1.0f;      ///< in [0, 1]
  float roughness = 1.0f;     ///< in [0, 1]; GGX's alpha is its square
  float transmission = 0.0f;  ///< in [0, 1]: so much of what is not metallic is (rough) glass
  MaterialMap map;            ///< times roughness (green code) and metallic (blue code)
  std::string metallic_file;  ///< where `map.file` has roughness alone: grey, put into one map
  float specular = 1.0f;      ///< in [0, 1]: so much of what is not metallic reflects at all, and
  glm::vec3 specular_color{1.0f};  ///< straight on in this colour: KHR_materials_specular
  float coat = 0.0f;  ///< in [0, 1]: weight of a clear layer over all, KHR_materials_clearcoat
  float coat_roughness = 0.0f;       ///< in [0, 1]
  MaterialMap transmission_map{};    ///< times the transmission: red code
  MaterialMap specular_map{};        ///< times `specular`: its opacity, as all three codes
  MaterialMap specular_color_map{};  ///< times specular_color: a colour
  MaterialMap coat_map{}, coat_roughness_map{};  ///< times these two: red code, green code
};

/// Calls visit(map) for each map of a metallic-roughness material.
template <class Shares, class Visit>
void for_each_map(Shares& shares, const Visit& visit) {
  for (auto* const map : {&shares.map, &shares.transmission_map, &shares.specular_map,
                          &shares.specular_color_map, &shares.coat_map, &shares.coat_roughness_map})
    visit(*map);
}

/// One material: of an MTL file, or what other files have in its terms. Colours are scene-linear
/// RGB, usually in [0, 1].
struct Material {
  std::string name;
  glm::vec3 diffuse{0.8f};        ///< Kd
  glm::vec3 specular{0.0f};       ///< Ks
  glm::vec3 emission{0.0f};       ///< Ke
  glm::vec3 transmittance{1.0f};  ///< Tf
  float shininess = 0.0f;         ///< Ns
  float refraction_index = 1.0f;  ///< Ni
  float opacity = 1.0f;           ///< d, or 1 - Tr
  int illumination_model = 2;     ///< illum
  std::string diffuse_map;        ///< map_Kd, joined to the MTL file's folder; empty: none
  TextureMapping diffuse_mapping;
  std::uint32_t diffuse_texture = kNoIndex;  ///< index into Scene::textures
  std::optional<MetallicRoughness> metallic_roughness;
  MaterialMap normal_map;           ///< codes 0 .. 1 are -1 .. 1 along tangent, bitangent, normal
  float normal_scale = 1.0f;        ///< of the first two
  MaterialMap emission_map;         ///< times the emission
  MaterialMap opacity_map;          ///< what is below opacity_cutoff there is not there
  float opacity_cutoff = 0.5f;      ///< in [0, 1]
  bool opacity_blends = false;      ///< there is no cutoff: the map is times the opacity
  bool has_vertex_opacity = false;  ///< Scene::opacities multiply the map
  bool has_vertex_colors = true;    ///< those of its vertices count
};

[[nodiscard]] inline bool emits(const Material& material) {
  return glm::any(glm::greaterThan(material.emission, glm::vec3(0.0f)));
}

/// One triangle: indices into the scene's arrays. Vertices run counter-clockwise seen from the
/// side the file means as the front.
struct Triangle {
  std::array<std::uint32_t, 3> vertices{};
  std::array<std::uint32_t, 3> normals{kNoIndex, kNoIndex, kNoIndex};
  std::array<std::uint32_t, 3> texcoords{kNoIndex, kNoIndex, kNoIndex};
  std::uint32_t material = 0;  ///< always valid: index into Scene::materials
  std::uint32_t object = 0;    ///< always valid: index into Scene::objects
};

/// Whether a triangle is a placeholder for (part of) a face without area: its vertices coincide. It
/// keeps the file's triangle number and is in no tree.
[[nodiscard]] inline bool is_left_out(const Triangle& triangle) {
  return triangle.vertices[0] == triangle.vertices[1];
}

/// Triangles that stand in several places: written once, in coordinates of their own. None of their
/// materials emits.
struct Mesh {
  std::vector<glm::vec3> positions;  ///< each of some triangle
  std::vector<Triangle> triangles;  ///< `vertices` are of these positions, all else is as elsewhere
  std::vector<glm::vec3> colors;    ///< as Scene::colors has them
};

/// A mesh in one of its places. instances.h has what it stands for.
struct Instance {
  /// From the mesh's positions to the scene's: three rows of a 3 x 4 matrix. Finite, of a
  /// determinant that is not negative: a mirrored mesh is a mesh of its own.
  double rows[3][4] = {{1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}};
  std::uint32_t mesh = 0;    ///< index into Scene::meshes
  std::uint32_t object = 0;  ///< added to the objects of the mesh's triangles
};

/// Where a spot light shines: within `inner` of its axis fully, beyond `outer` not at all, and
/// between them as KHR_lights_punctual of glTF says. Angles from the axis, in degrees, 0 <= inner
/// <= outer <= 90; equal ones make a hard edge.
struct SpotCone {
  glm::dvec3 axis{0.0, 0.0, -1.0};  ///< unit length, away from the light
  double inner = 0.0, outer = 45.0;
};

/// A light without size, whose irradiance at distance r is intensity / r^2.
struct PointLight {
  glm::vec3 position{0.0f};  ///< relative to the scene's origin
  /// Radiant intensity, scene-linear RGB; double, for it goes with the square of lengths. Of a spot
  /// light along its axis.
  glm::dvec3 intensity{0.0};
  std::optional<SpotCone> spot = {};  ///< none: it shines to all sides
};

/// A light from one direction, infinitely far away.
struct DirectionalLight {
  glm::dvec3 direction{0.0, -1.0, 0.0};  ///< in which the light goes; unit length
  glm::vec3 irradiance{0.0f};            ///< of a surface across it, scene-linear RGB
};

/// Radiance from where no geometry is, in place of a background: a latitude-longitude picture. Its
/// upper edge is straight up, its lower edge straight down; in its middle is what is ahead, to the
/// right of that what is on the right. Between the middles of texels it is bilinear; it goes on
/// from the right edge at the left one.
struct EnvironmentMap {
  int width = 0, height = 0;         ///< at least 1
  std::vector<glm::vec3> texels;     ///< row by row from the top; finite, none negative
  float strength = 1.0f;             ///< times the texels: radiance, scene-linear RGB
  glm::dvec3 up{0.0, 1.0, 0.0};      ///< where the picture's upper edge is; unit length
  glm::dvec3 ahead{0.0, 0.0, -1.0};  ///< and where its middle is; unit length, across `up`

  [[nodiscard]] const glm::vec3& texel(int x, int y) const {
    return texels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
  }
};

/// An environment map that is still in its file.
struct EnvironmentSetting {
  std::filesystem::path file;  ///< OpenEXR or Radiance HDR, latitude-longitude
  double rotation = 0.0;       ///< in degrees around what is up, counter-clockwise seen from above
  double strength = 1.0;       ///< times what the file has; 0 or more
};

/// Number of corners that binary32 does not hold as their files have them, and the largest error of
/// one of their coordinates, in the unit of its file. The corners of a mesh with instances are
/// counted once, in the mesh's own coordinates; their rounding after an instance's transform is not
/// counted.
struct CornerRounding {
  std::uint64_t corners = 0;
  double most = 0.0;

  void add(const CornerRounding& other) {
    corners += other.corners;
    most = std::max(most, other.most);
  }
};

/// All geometry, materials and lights besides the faces that emit. Positions are relative to
/// `origin`, which is subtracted in double before rounding to float, so that a scene far from the
/// world's origin keeps its digits.
///
/// A triangle's number is its place in `triangles`; those of the instances follow, one instance
/// after the other. Faces without area have numbers, too (see is_left_out).
struct Scene {
  std::vector<glm::vec3> positions;
  /// Of the positions, in their order, scene-linear RGB: they multiply the diffuse colour. Beyond
  /// its end, and where it is empty, they are white.
  std::vector<glm::vec3> colors;
  std::vector<glm::vec3> normals;  ///< unit length, where a triangle uses them
  /// Of the normals, in their order: where a normal map's x points, and the side of its y (1 or -1,
  /// along cross(normal, x)). 0, and beyond the end: as the texture coordinates say.
  std::vector<glm::vec4> tangents;
  std::vector<glm::vec2> texcoords;
  /// Of the texture coordinates, in their order: a second set. It may be shorter.
  std::vector<glm::vec2> second_texcoords;
  /// Of the texture coordinates, in their order: the vertices' opacity. Beyond the end it is 1.
  std::vector<float> opacities;
  std::vector<Triangle> triangles;
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;  ///< of meshes that are kept as such: see instances.h
  std::vector<Material> materials;  ///< never empty; a default stands where the file names none
  std::vector<Texture> textures;    ///< that materials of triangles name
  NameList objects;                 ///< never empty; "o" and "g" names of the file
  std::vector<PointLight> lights;
  std::vector<DirectionalLight> directional_lights;
  glm::vec3 background{0.0f};  ///< radiance from where no geometry is, scene-linear RGB
  std::optional<EnvironmentMap> environment;  ///< takes the background's place
  glm::dvec3 origin{0.0};                     ///< world = origin + position
  CornerRounding rounding;
  std::optional<CameraSetting> camera;       ///< the file's first one, in world coordinates
  std::optional<glm::dvec3> up;              ///< upwards, where the file's format says so
  bool is_usually_z_up = false;              ///< else: what is usual in the format, z or y
  std::vector<std::filesystem::path> files;  ///< that were read for it: OBJ, MTL and textures
  std::vector<std::string> warnings;         ///< "file:line: ...": of statements, then of faces
};

/// 64 bits, as 16 hexadecimal digits, of all that a scene was read to: geometry, materials,
/// textures, lights, instances.
/// Equal scenes have equal digests, on every machine of the same byte order; of two that differ,
/// one pair in 2^64 would. Against mistakes, not against malice: it is no cryptographic hash.
[[nodiscard]] std::string digest_of(const Scene& scene);

}  // namespace raygate
