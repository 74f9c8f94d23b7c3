// Textured values of a triangle's material at a point: colour, opacity, normal, roughness ...
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "host/scene/scene.h"

namespace raygate {

/// The diffuse colour of `triangle`, one of the scene's, at the point with these weights of its
/// vertices (they sum to 1): the material's Kd times its texture. Where the face has no texture
/// coordinates the texture counts as white.
[[nodiscard]] glm::vec3 diffuse_at(const Scene& scene, const Triangle& triangle,
                                   const glm::dvec3& weights);

/// The vertices' colours, one of Scene::colors or Mesh::colors, at that point.
[[nodiscard]] glm::vec3 vertex_color_at(const std::vector<glm::vec3>& colors,
                                        const Triangle& triangle, const glm::dvec3& weights);

/// Whether the mask of the triangle's material hides that point. Never, where it has none or the
/// face has no texture coordinates.
[[nodiscard]] bool is_masked_out(const Scene& scene, const Triangle& triangle,
                                 const glm::dvec3& weights);

/// Whether its mask hides no point whose weights differ from these by no more than `change`. May
/// say no where there is much of a texture to look at.
[[nodiscard]] bool is_nowhere_masked(const Scene& scene, const Triangle& triangle,
                                     const glm::dvec3& weights, const glm::dvec3& change);

/// The normal at that point by the map of the triangle's material, around `normal`, a unit vector
/// on the side where the vertices, at `corners`, run counter-clockwise: the map's x and y are along
/// the directions in which u and v grow (their part across the normal), or along the file's
/// tangents, which the `instance` of the triangle turns, if any. `normal` itself where there is no
/// map or where the texture coordinates have no direction.
[[nodiscard]] glm::vec3 mapped_normal(const Scene& scene, const Triangle& triangle,
                                      const std::array<glm::vec3, 3>& corners,
                                      const Instance* instance, const glm::dvec3& weights,
                                      const glm::vec3& normal);

/// What the texture of emission multiplies at that point: a colour. 1 where there is none, or the
/// face has no texture coordinates.
[[nodiscard]] glm::vec3 emission_factor_at(const Scene& scene, const Triangle& triangle,
                                           const glm::dvec3& weights);

/// The radiance that a material emits, in the mean over its texture.
[[nodiscard]] glm::dvec3 mean_emission(const Scene& scene, const Material& material);

/// The opacity at that point by a map that blends, without the material's own. 1 where there is
/// none, or the face has no texture coordinates.
[[nodiscard]] float opacity_factor_at(const Scene& scene, const Triangle& triangle,
                                      const glm::dvec3& weights);

/// What the textures of a metallic-roughness material multiply. 1 where it has none, or the face
/// has no texture coordinates.
struct MetallicRoughnessFactors {
  float roughness = 1.0f, metallic = 1.0f, transmission = 1.0f, specular = 1.0f, coat = 1.0f,
        coat_roughness = 1.0f;
  glm::vec3 specular_color{1.0f};
};
[[nodiscard]] MetallicRoughnessFactors metallic_roughness_factors_at(const Scene& scene,
                                                                     const Triangle& triangle,
                                                                     const glm::dvec3& weights);

}  // namespace raygate
