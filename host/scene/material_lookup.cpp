#include "host/scene/material_lookup.h"

#include <algorithm>
#include <cmath>

#include "host/scene/instances.h"

namespace raygate {
namespace {

/// Returns the texture coordinates of a vertex. The triangle must have texture coordinates.
glm::dvec2 texcoord(const TextureMapping& mapping, const Scene& scene, const Triangle& triangle,
                    int vertex) {
  const std::uint32_t at = triangle.texcoords[static_cast<std::size_t>(vertex)];
  const bool is_second = mapping.is_second && at < scene.second_texcoords.size();
  return glm::dvec2(is_second ? scene.second_texcoords[at] : scene.texcoords[at]);
}

/// Returns texture coordinates, or differences of them, scaled and rotated.
glm::dvec2 turned(const TextureMapping& mapping, const glm::dvec2& uv) {
  const glm::dvec2 scaled = uv * glm::dvec2(mapping.scale), turn(mapping.turn);
  return {turn.x * scaled.x - turn.y * scaled.y, turn.y * scaled.x + turn.x * scaled.y};
}

/// Returns the texture position of a point. The triangle must have texture coordinates.
glm::dvec2 place_on(const TextureMapping& mapping, const Scene& scene, const Triangle& triangle,
                    const glm::dvec3& weights) {
  glm::dvec2 uv(0.0);
  for (int k = 0; k < 3; ++k) {
    uv += weights[k] * texcoord(mapping, scene, triangle, k);
  }
  return turned(mapping, uv) + glm::dvec2(mapping.offset);
}

bool is_missing(const MaterialMap& map, const Triangle& triangle) {
  return map.texture == kNoIndex || triangle.texcoords[0] == kNoIndex;
}

/// Returns the codes of a map, from 0 to 1; 1 without a texture or texture coordinates.
glm::vec3 codes_of(const MaterialMap& map, const Scene& scene, const Triangle& triangle,
                   const glm::dvec3& weights) {
  if (is_missing(map, triangle)) return glm::vec3(1.0f);
  return scene.textures[map.texture].codes_at(place_on(map.mapping, scene, triangle, weights),
                                              map.mapping.sampling);
}

/// Returns the scene-linear colour of a map; white without a texture or texture coordinates.
glm::vec3 color_of(const MaterialMap& map, const Scene& scene, const Triangle& triangle,
                   const glm::dvec3& weights) {
  if (is_missing(map, triangle)) return glm::vec3(1.0f);
  return scene.textures[map.texture].at(place_on(map.mapping, scene, triangle, weights),
                                        map.mapping.sampling);
}

bool has_mask(const Scene& scene, const Triangle& triangle) {
  const Material& material = scene.materials[triangle.material];
  return (material.opacity_map.texture != kNoIndex || material.has_vertex_opacity) &&
         !material.opacity_blends && triangle.texcoords[0] != kNoIndex;
}

/// Returns the opacity of a vertex. The triangle must have texture coordinates.
double vertex_opacity(const Scene& scene, const Triangle& triangle, int vertex) {
  const std::uint32_t at = triangle.texcoords[static_cast<std::size_t>(vertex)];
  return at < scene.opacities.size() ? scene.opacities[at] : 1.0;
}

/// Returns opacity map times vertex opacity. The triangle must have texture coordinates.
float opacity_of(const Scene& scene, const Triangle& triangle, const glm::dvec3& weights) {
  const Material& material = scene.materials[triangle.material];
  const float mapped = codes_of(material.opacity_map, scene, triangle, weights).r;
  if (!material.has_vertex_opacity) return mapped;
  double between = 0.0;
  for (int k = 0; k < 3; ++k) between += weights[k] * vertex_opacity(scene, triangle, k);
  return mapped * static_cast<float>(between);
}

/// Returns the tangent at a point: a direction, and the sign of y; 0 if the file has none.
glm::dvec4 tangent_at(const Scene& scene, const Triangle& triangle, const Instance* instance,
                      const glm::dvec3& weights) {
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

}  // namespace

glm::vec3 diffuse_at(const Scene& scene, const Triangle& triangle, const glm::dvec3& weights) {
  const Material& material = scene.materials[triangle.material];
  return material.diffuse * color_of(material.diffuse_map, scene, triangle, weights);
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
  return has_mask(scene, triangle) &&
         opacity_of(scene, triangle, weights) < scene.materials[triangle.material].opacity_cutoff;
}

float opacity_factor_at(const Scene& scene, const Triangle& triangle, const glm::dvec3& weights) {
  const Material& material = scene.materials[triangle.material];
  if (!material.opacity_blends || triangle.texcoords[0] == kNoIndex) return 1.0f;
  return opacity_of(scene, triangle, weights);
}

glm::vec3 mapped_normal(const Scene& scene, const Triangle& triangle,
                        const std::array<glm::dvec3, 3>& corners, const Instance* instance,
                        const glm::dvec3& weights, const glm::vec3& normal) {
  const Material& material = scene.materials[triangle.material];
  const MaterialMap& map = material.normal_map;
  if (is_missing(map, triangle)) return normal;
  const auto uv = [&](int vertex) {
    return turned(map.mapping, texcoord(map.mapping, scene, triangle, vertex));
  };
  const glm::dvec2 to_1 = uv(1) - uv(0), to_2 = uv(2) - uv(0);
  const glm::dvec3 edge_1 = corners[1] - corners[0], edge_2 = corners[2] - corners[0];
  const double sign = to_1.x * to_2.y < to_1.y * to_2.x ? -1.0 : 1.0;
  const glm::dvec3 n(normal), along_u = sign * (edge_1 * to_2.y - edge_2 * to_1.y),
                              along_v = sign * (edge_2 * to_1.x - edge_1 * to_2.x);
  const glm::dvec4 given = tangent_at(scene, triangle, instance, weights);
  const glm::dvec3 along_x = given.w != 0.0 ? glm::dvec3(given) : along_u;
  const glm::dvec3 across = along_x - n * glm::dot(n, along_x);
  const double length = glm::length(across);
  const glm::dvec3 side = glm::cross(n, across);
  const double turn = given.w != 0.0 ? given.w : glm::dot(side, along_v);
  if (!(length > 0.0) || !std::isfinite(length) || turn == 0.0) return normal;
  const glm::dvec3 x = across / length, y = (turn < 0.0 ? -side : side) / length;
  const glm::dvec3 codes(codes_of(map, scene, triangle, weights));
  const double scale = material.normal_scale;
  const glm::dvec3 bent = x * ((2.0 * codes.x - 1.0) * scale) +
                          y * ((2.0 * codes.y - 1.0) * scale) + n * (2.0 * codes.z - 1.0);
  const double size = glm::length(bent);
  return size > 0.0 && std::isfinite(size) ? glm::vec3(bent / size) : normal;
}

glm::vec3 emission_factor_at(const Scene& scene, const Triangle& triangle,
                             const glm::dvec3& weights) {
  return color_of(scene.materials[triangle.material].emission_map, scene, triangle, weights);
}

glm::dvec3 mean_emission(const Scene& scene, const Material& material) {
  const glm::dvec3 emission(material.emission);
  const std::uint32_t texture = material.emission_map.texture;
  return texture == kNoIndex ? emission : emission * scene.textures[texture].mean_color();
}

MetallicRoughnessFactors metallic_roughness_factors_at(const Scene& scene, const Triangle& triangle,
                                                       const glm::dvec3& weights) {
  MetallicRoughnessFactors factors;
  const auto& model = scene.materials[triangle.material].metallic_roughness;
  if (!model || triangle.texcoords[0] == kNoIndex) return factors;
  const auto codes = [&](const MaterialMap& map) {
    return codes_of(map, scene, triangle, weights);
  };
  const bool is_one_map = model->metallic_map.texture == model->roughness_map.texture;
  const glm::vec3 rough = codes(model->roughness_map);
  factors.roughness = rough.g;
  factors.metallic = is_one_map ? rough.b : codes(model->metallic_map).b;
  factors.transmission = codes(model->transmission_map).r;
  factors.specular = codes(model->specular_map).r;
  factors.specular_color = color_of(model->specular_color_map, scene, triangle, weights);
  return factors;
}

}  // namespace raygate
