#include "host/scene/material_lookup.h"

#include <cmath>

#include "host/scene/instances.h"

namespace raygate {
namespace {

/// A point of a triangle, for lookups of its material.
struct Point {
  const Scene& scene;
  const Triangle& triangle;
  const glm::dvec3& weights;
  const Material& material = scene.materials[triangle.material];
  bool has_texcoords = triangle.texcoords[0] != kNoIndex;

  /// Returns the texture coordinates of a vertex. The triangle must have texture coordinates.
  [[nodiscard]] glm::dvec2 texcoord(const TextureMapping& mapping, int vertex) const {
    const std::uint32_t at = triangle.texcoords[static_cast<std::size_t>(vertex)];
    const bool is_second = mapping.is_second && at < scene.second_texcoords.size();
    return glm::dvec2(is_second ? scene.second_texcoords[at] : scene.texcoords[at]);
  }

  [[nodiscard]] bool has(const MaterialMap& map) const {
    return map.texture != kNoIndex && has_texcoords;
  }

  /// Returns the texture's codes at the point, from 0 to 1; 1 without a texture or coordinates.
  [[nodiscard]] glm::vec3 codes(const MaterialMap& map) const {
    if (!has(map)) return glm::vec3(1.0f);
    return scene.textures[map.texture].codes_at(place_on(map.mapping), map.mapping.sampling);
  }

  /// Returns the scene-linear colour of a map; white without a texture or texture coordinates.
  [[nodiscard]] glm::vec3 color(const MaterialMap& map) const {
    if (!has(map)) return glm::vec3(1.0f);
    return scene.textures[map.texture].at(place_on(map.mapping), map.mapping.sampling);
  }

  /// Returns opacity map times vertex opacity. The triangle must have texture coordinates.
  [[nodiscard]] float opacity() const {
    const float mapped = codes(material.opacity_map).r;
    if (!material.has_vertex_opacity) return mapped;
    double between = 0.0;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t at = triangle.texcoords[static_cast<std::size_t>(k)];
      between += weights[k] * (at < scene.opacities.size() ? double{scene.opacities[at]} : 1.0);
    }
    return mapped * static_cast<float>(between);
  }

  /// Returns the tangent in the format of Scene::tangents; 0 if the file has none.
  [[nodiscard]] glm::dvec4 tangent(const Instance* instance) const {
    glm::dvec3 sum(0.0);
    double side = 0.0;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t at = triangle.normals[static_cast<std::size_t>(k)];
      if (at >= scene.tangents.size() || scene.tangents[at].w == 0.0f) return glm::dvec4(0.0);
      const glm::vec4& own = scene.tangents[at];
      sum += weights[k] * glm::dvec3(instance == nullptr ? own : transform_tangent(*instance, own));
      side = own.w;
    }
    return {sum, side};
  }

  /// Returns texture coordinates, or differences of them, scaled and rotated.
  static glm::dvec2 turned(const TextureMapping& mapping, const glm::dvec2& uv) {
    const glm::dvec2 scaled = uv * glm::dvec2(mapping.scale), turn(mapping.turn);
    return {turn.x * scaled.x - turn.y * scaled.y, turn.y * scaled.x + turn.x * scaled.y};
  }

 private:
  [[nodiscard]] glm::dvec2 place_on(const TextureMapping& mapping) const {
    glm::dvec2 uv(0.0);
    for (int k = 0; k < 3; ++k) uv += weights[k] * texcoord(mapping, k);
    return turned(mapping, uv) + glm::dvec2(mapping.offset);
  }
};

}  // namespace

glm::vec3 diffuse_at(const Scene& scene, const Triangle& triangle, const glm::dvec3& weights) {
  const Point point{scene, triangle, weights};
  return point.material.diffuse * point.color(point.material.diffuse_map);
}

glm::vec3 vertex_color_at(const std::vector<glm::vec3>& colors, const Triangle& triangle,
                          const glm::dvec3& weights) {
  glm::dvec3 color(0.0);
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t vertex = triangle.vertices[static_cast<std::size_t>(k)];
    color += weights[k] * (vertex < colors.size() ? glm::dvec3(colors[vertex]) : glm::dvec3(1.0));
  }
  return glm::vec3(color);
}

bool is_masked_out(const Scene& scene, const Triangle& triangle, const glm::dvec3& weights) {
  const Point point{scene, triangle, weights};
  const Material& material = point.material;
  const bool has_mask = (material.opacity_map.texture != kNoIndex || material.has_vertex_opacity) &&
                        !material.opacity_blends && point.has_texcoords;
  return has_mask && point.opacity() < material.opacity_cutoff;
}

float opacity_factor_at(const Scene& scene, const Triangle& triangle, const glm::dvec3& weights) {
  const Point point{scene, triangle, weights};
  return point.material.opacity_blends && point.has_texcoords ? point.opacity() : 1.0f;
}

glm::vec3 mapped_normal(const Scene& scene, const Triangle& triangle,
                        const std::array<glm::dvec3, 3>& corners, const Instance* instance,
                        const glm::dvec3& weights, const glm::vec3& normal) {
  const Point point{scene, triangle, weights};
  const MaterialMap& map = point.material.normal_map;
  if (!point.has(map)) return normal;
  const auto uv = [&](int vertex) {
    return Point::turned(map.mapping, point.texcoord(map.mapping, vertex));
  };
  const glm::dvec2 to_1 = uv(1) - uv(0), to_2 = uv(2) - uv(0);
  const glm::dvec3 edge_1 = corners[1] - corners[0], edge_2 = corners[2] - corners[0];
  const double sign = to_1.x * to_2.y < to_1.y * to_2.x ? -1.0 : 1.0;
  const glm::dvec3 n(normal), along_u = sign * (edge_1 * to_2.y - edge_2 * to_1.y),
                              along_v = sign * (edge_2 * to_1.x - edge_1 * to_2.x);
  const glm::dvec4 given = point.tangent(instance);
  const glm::dvec3 along_x = given.w != 0.0 ? glm::dvec3(given) : along_u;
  const glm::dvec3 across = along_x - n * glm::dot(n, along_x);
  const double length = glm::length(across);
  const glm::dvec3 side = glm::cross(n, across);
  const double turn = given.w != 0.0 ? given.w : glm::dot(side, along_v);
  if (!(length > 0.0) || !std::isfinite(length) || turn == 0.0) return normal;
  const glm::dvec3 x = across / length, y = (turn < 0.0 ? -side : side) / length;
  const glm::dvec3 codes(point.codes(map));
  const double scale = point.material.normal_scale;
  const glm::dvec3 bent = x * ((2.0 * codes.x - 1.0) * scale) +
                          y * ((2.0 * codes.y - 1.0) * scale) + n * (2.0 * codes.z - 1.0);
  const double size = glm::length(bent);
  return size > 0.0 && std::isfinite(size) ? glm::vec3(bent / size) : normal;
}

glm::vec3 emission_factor_at(const Scene& scene, const Triangle& triangle,
                             const glm::dvec3& weights) {
  const Point point{scene, triangle, weights};
  return point.color(point.material.emission_map);
}

glm::dvec3 mean_emission(const Scene& scene, const Material& material) {
  const glm::dvec3 emission(material.emission);
  const std::uint32_t texture = material.emission_map.texture;
  return texture == kNoIndex ? emission : emission * scene.textures[texture].mean_color();
}

MetallicRoughnessFactors metallic_roughness_factors_at(const Scene& scene, const Triangle& triangle,
                                                       const glm::dvec3& weights) {
  MetallicRoughnessFactors factors;
  const Point point{scene, triangle, weights};
  const auto& model = point.material.metallic_roughness;
  if (!model || !point.has_texcoords) return factors;
  const bool is_one_map = model->metallic_map.texture == model->roughness_map.texture;
  const glm::vec3 rough = point.codes(model->roughness_map);
  factors.roughness = rough.g;
  factors.metallic = is_one_map ? rough.b : point.codes(model->metallic_map).b;
  factors.transmission = point.codes(model->transmission_map).r;
  factors.specular = point.codes(model->specular_map).r;
  factors.specular_color = point.color(model->specular_color_map);
  return factors;
}

}  // namespace raygate
