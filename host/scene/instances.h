// A scene's instances: all of their triangles, and how they become triangles like others.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "host/exact/exact.h"
#include "host/scene/instance_transform.h"
#include "host/scene/scene.h"

namespace raygate {

/// Of the scene, all instances' included.
[[nodiscard]] std::uint64_t triangle_count(const Scene& scene);

/// Makes triangles of the part's into a mesh of the scene, which takes over the part's normals,
/// texture coordinates, materials, textures and objects, too; `part.materials` may be empty: its
/// triangles have the scene's then. The mesh's number; its coordinates are relative to
/// `part.origin`.
std::uint32_t add_mesh(Scene& scene, Scene&& part);

/// A copy of a mesh whose triangles run the other way round; its number. For mirrored instances.
std::uint32_t add_mirrored(Scene& scene, std::uint32_t mesh);

/// Writes the instances out: they become triangles like others, of the same numbers, corners and
/// normals, and no instance is left.
void flatten_instances(Scene& scene);

/// What becomes of instances.
enum class InstanceMode {
  kFlatten,    ///< they are written out
  kKeep,       ///< each mesh is in memory once
  kAutomatic,  ///< kept where more than kFlattenLimit would be written
};
inline constexpr std::uint64_t kFlattenLimit = 4'000'000;

/// Writes out what is not to be kept, and in any case what emits: area lights are lists of
/// triangles. What is numbered how does not depend on `use`. False, and nothing is done, where
/// there are about 2^31 triangles or more.
[[nodiscard]] bool resolve_instances(Scene& scene, InstanceMode use);

/// A box of coordinates in double.
struct Bounds3 {
  glm::dvec3 low, high;
};

/// A box around positions, at least one; around where an instance has that box (and no tighter).
[[nodiscard]] Bounds3 bounds_of(std::span<const glm::vec3> positions);
[[nodiscard]] Bounds3 transform_bounds(const double (&rows)[3][4], const Bounds3& box);

/// Makes the box hold all positions of the scene's instances; no larger than they ask for.
void expand_by_instances(const Scene& scene, Bounds3& box);

/// Neither triangles nor instances.
[[nodiscard]] inline bool is_empty(const Scene& scene) {
  return scene.triangles.empty() && scene.instances.empty();
}

/// The box around the corners of all triangles, instances' included; of a scene with any.
[[nodiscard]] Bounds3 triangle_bounds(const Scene& scene);
/// The same around all positions, those of no triangle, too; of a scene with any.
[[nodiscard]] Bounds3 position_bounds(const Scene& scene);

/// Calls visit(position) for all positions of the scene and of its instances.
template <class Visit>
void for_each_position(const Scene& scene, const Visit& visit) {
  for (const glm::vec3& position : scene.positions) visit(position);
  for (const Instance& instance : scene.instances) {
    for (const glm::vec3& position : scene.meshes[instance.mesh].positions) {
      visit(transform_point(instance.rows, position));
    }
  }
}

/// Calls visit(corners, face) for all triangles of the scene in the order of their numbers.
template <class Visit>
void for_each_face(const Scene& scene, const Visit& visit) {
  Corners corners;
  for (const Triangle& face : scene.triangles) {
    for (std::size_t k = 0; k < 3; ++k) corners[k] = scene.positions[face.vertices[k]];
    visit(corners, face);
  }
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    for (const Triangle& face : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = transform_point(instance.rows, mesh.positions[face.vertices[k]]);
      }
      visit(corners, face);
    }
  }
}

}  // namespace raygate
