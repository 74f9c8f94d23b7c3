// Textured material values at a point of a triangle: colour, opacity, normal, roughness.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "host/scene/scene.h"

namespace raygate {

// Points are given by a triangle and barycentric coordinates (`weights`, with sum 1). Maps count as
// 1 for a triangle without texture coordinates.

/// Returns the diffuse colour at a point: Kd times its texture.
[[nodiscard]] glm::vec3 diffuse_at(const Scene& scene, const Triangle& triangle,
                                   const glm::dvec3& weights);

/// Interpolates the vertex colours, Scene::colors or Mesh::colors, at a point of the triangle.
[[nodiscard]] glm::vec3 vertex_color_at(const std::vector<glm::vec3>& colors,
                                        const Triangle& triangle, const glm::dvec3& weights);

/// Returns whether the opacity mask of the triangle's material hides the point.
[[nodiscard]] bool is_masked_out(const Scene& scene, const Triangle& triangle,
                                 const glm::dvec3& weights);

/// Returns the normal map's shading normal at a point. `normal` is the unit normal on the side from
/// which `corners` are counter-clockwise. The map's axes are the file's tangents, transformed by
/// `instance` (nullptr: none), or else the directions in which u and v increase, both projected
/// onto the tangent plane. Returns `normal` if there is no map or the axes are degenerate.
[[nodiscard]] glm::vec3 mapped_normal(const Scene& scene, const Triangle& triangle,
                                      const std::array<glm::dvec3, 3>& corners,
                                      const Instance* instance, const glm::dvec3& weights,
                                      const glm::vec3& normal);

/// Returns the emission map's colour at a point.
[[nodiscard]] glm::vec3 emission_factor_at(const Scene& scene, const Triangle& triangle,
                                           const glm::dvec3& weights);

/// Returns the radiance that a material emits, averaged over its texture.
[[nodiscard]] glm::dvec3 mean_emission(const Scene& scene, const Material& material);

/// Returns the blending opacity map's value at a point, without Material::opacity; 1 if no map.
[[nodiscard]] float opacity_factor_at(const Scene& scene, const Triangle& triangle,
                                      const glm::dvec3& weights);

/// Factors from metallic-roughness textures.
struct MetallicRoughnessFactors {
  float roughness = 1.0f, metallic = 1.0f, transmission = 1.0f, specular = 1.0f;
  glm::vec3 specular_color{1.0f};
};
[[nodiscard]] MetallicRoughnessFactors metallic_roughness_factors_at(const Scene& scene,
                                                                     const Triangle& triangle,
                                                                     const glm::dvec3& weights);

}  // namespace raygate
