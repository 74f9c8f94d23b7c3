// Scene: triangles, materials, textures, lights and instances, relative to an origin.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "host/exact/exact.h"
#include "host/scene/camera.h"
#include "host/scene/texture.h"

namespace raygate {

/// Index that stands for no normal, texture coordinate, material or texture.
inline constexpr std::uint32_t kNoIndex = std::numeric_limits<std::uint32_t>::max();

/// Maps a surface's texture coordinates to a texture: scale * (u, v), rotated, plus offset.
struct TextureMapping {
  glm::vec2 scale{1.0f};       ///< MTL option -s
  glm::vec2 offset{0.0f};      ///< MTL option -o
  Sampling sampling;           ///< MTL's "-clamp on" is Wrap::kClamp
  glm::vec2 turn{1.0f, 0.0f};  ///< cosine and sine of a counter-clockwise rotation
  bool is_second = false;      ///< uses Scene::second_texcoords
};

/// A texture of a material, and its mapping.
struct MaterialMap {
  std::string file;  ///< path, with the folder of the MTL file; empty: no texture, or embedded
  TextureMapping mapping;
  std::uint32_t texture = kNoIndex;  ///< index into Scene::textures
};

/// The metallic-roughness model of glTF 2.0 (appendix B), which replaces the lobes of `illum`. The
/// base colour is Material::diffuse times its texture. Material::refraction_index, where 1 counts
/// as 1.5, gives the reflectance of the dielectric part.
struct MetallicRoughness {
  float metallic = 1.0f;      ///< in [0, 1]
  float roughness = 1.0f;     ///< in [0, 1]; its square is the alpha of GGX
  float transmission = 0.0f;  ///< in [0, 1]: fraction of the dielectric part that is (rough) glass
  float specular = 1.0f;  ///< in [0, 1]: strength of dielectric reflection (KHR_materials_specular)
  /// Colour of dielectric reflection at normal incidence (KHR_materials_specular).
  glm::vec3 specular_color{1.0f};
  // Maps that multiply these values, and the channels that they use.
  MaterialMap roughness_map{};       ///< green
  MaterialMap metallic_map{};        ///< blue
  MaterialMap transmission_map{};    ///< red
  MaterialMap specular_map{};        ///< opacity, stored in all three channels
  MaterialMap specular_color_map{};  ///< scene-linear RGB
};

/// A material, in the terms of MTL files. Colours are scene-linear RGB, usually in [0, 1].
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
  MaterialMap diffuse_map;        ///< map_Kd; multiplies `diffuse`
  std::optional<MetallicRoughness> metallic_roughness;
  MaterialMap normal_map;       ///< codes 0 to 1 are -1 to 1 along tangent, bitangent and normal
  float normal_scale = 1.0f;    ///< multiplies the map's x and y
  MaterialMap emission_map;     ///< multiplies emission
  MaterialMap opacity_map;      ///< hides points where the map is below opacity_cutoff
  float opacity_cutoff = 0.5f;  ///< in [0, 1]
  bool opacity_blends = false;  ///< the map multiplies the opacity; no cutoff
  bool has_vertex_opacity = false;  ///< Scene::opacities multiply the map
  bool has_vertex_colors = true;    ///< vertex colours multiply `diffuse`
};

/// Calls visit(map) for each map of a metallic-roughness material.
template <class Model, class Visit>
void for_each_map(Model& model, const Visit& visit) {
  for (auto* const map : {&model.roughness_map, &model.transmission_map, &model.specular_map,
                          &model.specular_color_map, &model.metallic_map}) {
    visit(*map);
  }
}

/// Calls visit(map) for each map of a material.
template <class Visit>
void for_each_map(Material& material, const Visit& visit) {
  visit(material.diffuse_map);
  visit(material.normal_map);
  visit(material.emission_map);
  visit(material.opacity_map);
  if (material.metallic_roughness) for_each_map(*material.metallic_roughness, visit);
}

[[nodiscard]] inline bool emits(const Material& material) {
  return glm::any(glm::greaterThan(material.emission, glm::vec3(0.0f)));
}

/// A triangle: indices into the scene's arrays. Vertices are counter-clockwise seen from the front.
struct Triangle {
  std::array<std::uint32_t, 3> vertices{};
  std::array<std::uint32_t, 3> normals{kNoIndex, kNoIndex, kNoIndex};
  std::array<std::uint32_t, 3> texcoords{kNoIndex, kNoIndex, kNoIndex};
  std::uint32_t material = 0;  ///< always a valid index into Scene::materials
  std::uint32_t object = 0;    ///< always a valid index into Scene::objects
};

/// Returns whether a triangle is a placeholder for (part of) a face without area: two of its
/// vertices coincide. Placeholders have indices but are in no BVH.
[[nodiscard]] inline bool is_left_out(const Triangle& triangle) {
  return triangle.vertices[0] == triangle.vertices[1];
}

/// Triangles that instances share, in the mesh's own coordinates. Their materials emit no light.
struct Mesh {
  std::vector<glm::vec3> positions;  ///< each is a vertex of a triangle
  std::vector<Triangle> triangles;   ///< `vertices` index `positions`; other indices refer to Scene
  std::vector<glm::vec3> colors;     ///< in the format of Scene::colors
};

/// An instance of a mesh; see instances.h.
struct Instance {
  /// Transform from the mesh's positions to the scene's: a finite 3 x 4 matrix of non-negative
  /// determinant. A mirrored mesh is stored as a mesh of its own.
  double rows[3][4] = {{1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}};
  std::uint32_t mesh = 0;    ///< index into Scene::meshes
  std::uint32_t object = 0;  ///< added to the objects of the mesh's triangles
};

/// Cone of a spot light: full intensity within `inner`, none beyond `outer`, and the falloff of
/// KHR_lights_punctual (glTF) between. Angles are from the axis, in degrees, 0 <= inner <= outer <=
/// 90. Equal angles give a hard edge.
struct SpotCone {
  glm::dvec3 axis{0.0, 0.0, -1.0};  ///< unit length, away from the light
  double inner = 0.0, outer = 45.0;
};

/// A point light. The irradiance at distance r is intensity / r^2.
template <class Position>
struct PointLightAt {
  Position position{0.0f};
  glm::dvec3 intensity{0.0};          ///< radiant, scene-linear RGB; for a spot light, on the axis
  std::optional<SpotCone> spot = {};  ///< none: isotropic
};
using PointLight = PointLightAt<glm::vec3>;  ///< position relative to Scene::origin
/// A point light in world coordinates, for scenes whose origin is not known yet.
using WorldPointLight = PointLightAt<glm::dvec3>;

/// A directional light, infinitely far away.
struct DirectionalLight {
  glm::dvec3 direction{0.0, -1.0, 0.0};  ///< direction of propagation; unit length
  glm::vec3 irradiance{0.0f};  ///< on a surface perpendicular to `direction`, scene-linear RGB
};

/// A latitude-longitude image of the radiance from outside the scene, in place of a background. Its
/// upper edge is in direction `up`, its centre in direction `ahead`, its right half to the right of
/// an observer who looks ahead. Lookup is bilinear between texel centres and wraps horizontally.
struct EnvironmentMap {
  int width = 0, height = 0;      ///< at least 1
  std::vector<glm::vec3> texels;  ///< row by row from the top; finite, not negative
  float strength = 1.0f;          ///< factor from texels to radiance, scene-linear RGB
  glm::dvec3 up{0.0, 1.0, 0.0};   ///< direction of the image's upper edge; unit length
  /// Direction of the image's centre; unit length, perpendicular to `up`.
  glm::dvec3 ahead{0.0, 0.0, -1.0};

  [[nodiscard]] const glm::vec3& texel(int x, int y) const {
    return texels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
  }
};

/// An environment map that has not been loaded; none if `file` is empty.
struct EnvironmentSetting {
  std::filesystem::path file;  ///< OpenEXR or Radiance HDR, latitude-longitude
  double rotation = 0.0;  ///< around the up axis, in degrees, counter-clockwise seen from above
  double strength = 1.0;  ///< multiplies the file's values; at least 0
};

/// Statistics of rounding: the number of corners that are not stored as they are in the file, and
/// the largest error of a coordinate, in the file's unit. A mesh with instances is counted once, in
/// its own coordinates; rounding after an instance transform is not counted.
struct CornerRounding {
  std::uint64_t corners = 0;
  double most = 0.0;

  void add(const CornerRounding& other) {
    corners += other.corners;
    most = std::max(most, other.most);
  }
};

/// Resizes a list of optional vertex attributes to `count` elements and sets the last one to
/// `value`. New elements before it are `missing`.
template <class T>
void set_last(std::vector<T>& attributes, std::size_t count, const T& value, const T& missing) {
  attributes.resize(count, missing);
  attributes.back() = value;
}

/// All geometry, materials and lights. Emissive triangles are lights, too. Positions are relative
/// to `origin`. A position and its rest give a binary64 position; a position without a rest is
/// rounded to binary32.
///
/// Triangles are indexed in the order of `triangles`, followed by those of each instance in turn.
/// Faces without area have indices, too (see is_left_out).
struct Scene {
  std::vector<glm::vec3> positions;
  /// Rests (see rest_of) of the first rests.size() positions. All later positions have no rest.
  std::vector<glm::ivec3> rests;
  /// Scene-linear RGB of the first colors.size() positions. Multiplies the diffuse colour.
  std::vector<glm::vec3> colors;
  std::vector<glm::vec3> normals;  ///< unit length if a triangle uses them
  /// Tangents of the first normals: xyz is the normal map's x axis, w (1 or -1) the sign of its y
  /// axis along cross(normal, x). If missing or 0, texture coordinates define the axes.
  std::vector<glm::vec4> tangents;
  std::vector<glm::vec2> texcoords;
  /// Second set, for the first elements of `texcoords`; the others have no second coordinates.
  std::vector<glm::vec2> second_texcoords;
  /// Vertex opacities, for the first elements of `texcoords`; the opacity of the others is 1.
  std::vector<float> opacities;
  std::vector<Triangle> triangles;
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;   ///< instances that were not flattened; see instances.h
  std::vector<Material> materials;   ///< never empty: has a default material if the file names none
  std::vector<Texture> textures;     ///< used by materials of triangles
  std::vector<std::string> objects;  ///< never empty; "o" and "g" names of the file
  std::vector<PointLight> lights;
  std::vector<DirectionalLight> directional_lights;
  glm::vec3 background{0.0f};                 ///< radiance from outside the scene, scene-linear RGB
  std::optional<EnvironmentMap> environment;  ///< replaces `background`
  glm::dvec3 origin{0.0};                     ///< world position = origin + position
  CornerRounding rounding;
  std::optional<CameraSetting> camera;  ///< the file's first camera, in world coordinates
  /// Up direction that the format defines, or else the usual one: +y or +z.
  glm::dvec3 up{0.0, 1.0, 0.0};
  std::vector<std::filesystem::path> files;  ///< all files read: OBJ, MTL and textures
  std::vector<std::string> warnings;  ///< "file:line: ..."; on statements first, then on faces

  /// Returns a position in binary64.
  [[nodiscard]] glm::dvec3 vertex(std::uint32_t index) const {
    if (index >= rests.size()) return positions[index];
    glm::dvec3 exact;
    for (int k = 0; k < 3; ++k) exact[k] = with_rest(positions[index][k], rests[index][k]);
    return exact;
  }
  /// Adds a position, given in world coordinates, and its rest. All earlier positions must have
  /// rests. Returns the largest error of a coordinate: 0 if and only if all are exact.
  double add_vertex(const glm::dvec3& world);
  /// Removes the rests if all are 0.
  void drop_zero_rests() {
    if (std::ranges::count(rests, glm::ivec3(0)) == std::ssize(rests)) rests = {};
  }
};

/// Adds a light to a scene whose origin is set. Throws InputError if its position overflows float.
void add_light(Scene& scene, const WorldPointLight& light, const std::string& file);

/// Adds triangles (0, 1, 2) and (0, 2, 3) of `corners`, the material, and an object named after it.
void add_quad(Scene& scene, const std::array<glm::vec3, 4>& corners, const Material& material);

/// Returns a 64-bit digest, as 16 hexadecimal digits, of a scene's geometry, materials, textures,
/// lights and instances. Equal scenes have equal digests on all machines of the same byte order;
/// different ones collide with probability 2^-64. This is not a cryptographic hash.
[[nodiscard]] std::string digest_of(const Scene& scene);

}  // namespace raygate
