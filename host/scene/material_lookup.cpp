#include "host/scene/material_lookup.h"

#include <cmath>

namespace raygate {
namespace {

/// Where on its texture a point of a triangle is that has texture coordinates.
glm::dvec2 place_on(const TextureMapping& mapping, const Scene& scene, const Triangle& triangle,
                    const glm::dvec3& weights) {
  glm::dvec2 uv(0.0);
  for (int k = 0; k < 3; ++k) {
    uv += weights[k] * glm::dvec2(scene.texcoords[triangle.texcoords[static_cast<std::size_t>(k)]]);
  }
  return uv * glm::dvec2(mapping.scale) + glm::dvec2(mapping.offset);
}

Wrap wrap_of(const TextureMapping& mapping) { return mapping.clamp ? Wrap::kClamp : Wrap::kRepeat; }

bool has_mask(const Scene& scene, const Triangle& triangle) {
  const Material& material = scene.materials[triangle.material];
  return material.opacity_map.texture != kNoIndex && !material.opacity_blends &&
         triangle.texcoords[0] != kNoIndex;
}

/// The codes of a map, from 0 to 1.
glm::vec3 codes_of(const MaterialMap& map, const Scene& scene, const Triangle& triangle,
                   const glm::dvec3& weights) {
  if (map.texture == kNoIndex) return glm::vec3(1.0f);
  return scene.textures[map.texture].codes_at(place_on(map.mapping, scene, triangle, weights),
                                              wrap_of(map.mapping));
}

}  // namespace

glm::vec3 diffuse_at(const Scene& scene, const Triangle& triangle, const glm::dvec3& weights) {
  const Material& material = scene.materials[triangle.material];
  if (material.diffuse_texture == kNoIndex || triangle.texcoords[0] == kNoIndex) {
    return material.diffuse;
  }
  const TextureMapping& mapping = material.diffuse_mapping;
  return material.diffuse * scene.textures[material.diffuse_texture].at(
                                place_on(mapping, scene, triangle, weights), wrap_of(mapping));
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
  if (!has_mask(scene, triangle)) return false;
  const Material& material = scene.materials[triangle.material];
  return codes_of(material.opacity_map, scene, triangle, weights).r < material.opacity_cutoff;
}

bool is_nowhere_masked(const Scene& scene, const Triangle& triangle, const glm::dvec3& weights,
                       const glm::dvec3& change) {
  if (!has_mask(scene, triangle)) return true;
  const Material& material = scene.materials[triangle.material];
  const TextureMapping& mapping = material.opacity_map.mapping;
  const auto uv = [&](std::size_t k) { return glm::dvec2(scene.texcoords[triangle.texcoords[k]]); };
  // Changes of weights have the sum 0.
  const glm::dvec2 reach =
      (change.y * glm::abs(uv(1) - uv(0)) + change.z * glm::abs(uv(2) - uv(0))) *
      glm::abs(glm::dvec2(mapping.scale));
  constexpr double kRounding = 1e-6;
  return scene.textures[material.opacity_map.texture].min_code_near(
             place_on(mapping, scene, triangle, weights), reach, wrap_of(mapping)) >
         material.opacity_cutoff + kRounding;
}

float opacity_factor_at(const Scene& scene, const Triangle& triangle, const glm::dvec3& weights) {
  const Material& material = scene.materials[triangle.material];
  if (!material.opacity_blends || triangle.texcoords[0] == kNoIndex) return 1.0f;
  return codes_of(material.opacity_map, scene, triangle, weights).r;
}

glm::vec3 mapped_normal(const Scene& scene, const Triangle& triangle,
                        const std::array<glm::vec3, 3>& corners, const glm::dvec3& weights,
                        const glm::vec3& normal) {
  const Material& material = scene.materials[triangle.material];
  const MaterialMap& map = material.normal_map;
  if (map.texture == kNoIndex || triangle.texcoords[0] == kNoIndex) return normal;
  const auto uv = [&](std::size_t k) {
    return glm::dvec2(scene.texcoords[triangle.texcoords[k]]) * glm::dvec2(map.mapping.scale);
  };
  const glm::dvec2 to_1 = uv(1) - uv(0), to_2 = uv(2) - uv(0);
  const glm::dvec3 a(corners[0]), edge_1 = glm::dvec3(corners[1]) - a,
                                  edge_2 = glm::dvec3(corners[2]) - a;
  const double sign = to_1.x * to_2.y < to_1.y * to_2.x ? -1.0 : 1.0;
  const glm::dvec3 n(normal), along_u = sign * (edge_1 * to_2.y - edge_2 * to_1.y),
                              along_v = sign * (edge_2 * to_1.x - edge_1 * to_2.x);
  const glm::dvec3 across = along_u - n * glm::dot(n, along_u);
  const double length = glm::length(across);
  const glm::dvec3 side = glm::cross(n, across);
  const double turn = glm::dot(side, along_v);
  if (!(length > 0.0) || !std::isfinite(length) || turn == 0.0) return normal;
  const glm::dvec3 x = across / length, y = (turn < 0.0 ? -side : side) / length;
  const glm::dvec2 place = place_on(map.mapping, scene, triangle, weights);
  const glm::dvec3 codes(scene.textures[map.texture].codes_at(place, wrap_of(map.mapping)));
  const double scale = material.normal_scale;
  const glm::dvec3 bent = x * ((2.0 * codes.x - 1.0) * scale) +
                          y * ((2.0 * codes.y - 1.0) * scale) + n * (2.0 * codes.z - 1.0);
  const double size = glm::length(bent);
  return size > 0.0 && std::isfinite(size) ? glm::vec3(bent / size) : normal;
}

glm::vec3 emission_factor_at(const Scene& scene, const Triangle& triangle,
                             const glm::dvec3& weights) {
  const MaterialMap& map = scene.materials[triangle.material].emission_map;
  if (map.texture == kNoIndex || triangle.texcoords[0] == kNoIndex) return glm::vec3(1.0f);
  return scene.textures[map.texture].at(place_on(map.mapping, scene, triangle, weights),
                                        wrap_of(map.mapping));
}

glm::dvec3 mean_emission(const Scene& scene, const Material& material) {
  const glm::dvec3 emission(material.emission);
  const std::uint32_t texture = material.emission_map.texture;
  return texture == kNoIndex ? emission : emission * scene.textures[texture].mean_color();
}

MetallicRoughnessFactors metallic_roughness_factors_at(const Scene& scene, const Triangle& triangle,
                                                       const glm::dvec3& weights) {
  MetallicRoughnessFactors factors;
  const auto& shares = scene.materials[triangle.material].metallic_roughness;
  if (!shares || triangle.texcoords[0] == kNoIndex) return factors;
  const auto codes = [&](const MaterialMap& map) {
    return codes_of(map, scene, triangle, weights);
  };
  const glm::vec3 map = codes(shares->map);
  factors.roughness = map.g;
  factors.metallic = map.b;
  factors.transmission = codes(shares->transmission_map).r;
  factors.specular = codes(shares->specular_map).r;
  factors.coat = codes(shares->coat_map).r;
  factors.coat_roughness = codes(shares->coat_roughness_map).g;
  if (const MaterialMap& color = shares->specular_color_map; color.texture != kNoIndex) {
    factors.specular_color = scene.textures[color.texture].at(
        place_on(color.mapping, scene, triangle, weights), wrap_of(color.mapping));
  }
  return factors;
}

}  // namespace raygate
