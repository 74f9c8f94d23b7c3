// Instances of a scene: where they put the points of their mesh, how they are made and flattened.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>

#include "host/base/vectors.h"
#include "host/scene/scene.h"

namespace raygate {

/// A coordinate of a point after a row of Instance::rows, before it is rounded to float. T: double,
/// or a vector of them. One sequence of operations for everyone.
template <class T>
RAYGATE_INLINE void transform_coordinate(const double (&row)[4], const T (&point)[3], T& result) {
  result = ((row[0] * point[0] + row[1] * point[1]) + row[2] * point[2]) + row[3];
}

/// Where an instance of these rows has a position of its mesh: everybody's corners are these
/// floats.
[[nodiscard]] inline glm::vec3 transform_point(const double (&rows)[3][4],
                                               const glm::vec3& position) {
  const double point[3] = {position.x, position.y, position.z};
  glm::vec3 result;
  for (int k = 0; k < 3; ++k) {
    double coordinate;
    transform_coordinate(rows[k], point, coordinate);
    result[k] = static_cast<float>(coordinate);
  }
  return result;
}

/// A normal of the mesh as the instance has it, of unit length; 0 where the instance leaves nothing
/// of it. By the inverse transpose but for a factor, which a flat matrix has, too.
[[nodiscard]] inline glm::vec3 transform_normal(const Instance& instance, const glm::vec3& normal) {
  glm::dvec3 row[3];
  for (int k = 0; k < 3; ++k) {
    row[k] = {instance.rows[k][0], instance.rows[k][1], instance.rows[k][2]};
  }
  const glm::dvec3 n(normal);
  const glm::dvec3 turned(glm::dot(glm::cross(row[1], row[2]), n),
                          glm::dot(glm::cross(row[2], row[0]), n),
                          glm::dot(glm::cross(row[0], row[1]), n));
  // Scaled first, so that neither tiny nor huge components are lost in the squares.
  const double size = std::max({std::abs(turned.x), std::abs(turned.y), std::abs(turned.z)});
  if (!(size > 0.0 && std::isfinite(size))) return glm::vec3(0.0f);
  return glm::vec3(glm::normalize(turned / size));
}

/// Returns a tangent, as Scene::tangents has them, of a mesh as the instance has it.
[[nodiscard]] inline glm::vec4 transform_tangent(const Instance& instance,
                                                 const glm::vec4& tangent) {
  glm::dvec3 turned;
  for (int k = 0; k < 3; ++k) {
    const auto& row = instance.rows[k];
    turned[k] = row[0] * tangent.x + row[1] * tangent.y + row[2] * tangent.z;
  }
  const double size = glm::length(turned);
  if (!(size > 0.0 && std::isfinite(size))) return glm::vec4(0.0f);
  return {glm::vec3(turned / size), tangent.w};
}

/// A triangle, by where it is stored.
struct FaceRef {
  std::uint32_t instance = kNoIndex;  ///< kNoIndex: it is one of Scene::triangles
  std::uint32_t triangle = 0;         ///< of these, or of the instance's mesh
};

[[nodiscard]] inline const Triangle& face_at(const Scene& scene, const FaceRef& face) {
  if (face.instance == kNoIndex) [[likely]]
    return scene.triangles[face.triangle];
  return scene.meshes[scene.instances[face.instance].mesh].triangles[face.triangle];
}

/// The instance of a stored triangle; nullptr for one of Scene::triangles.
[[nodiscard]] inline const Instance* instance_at(const Scene& scene, const FaceRef& face) {
  return face.instance == kNoIndex ? nullptr : &scene.instances[face.instance];
}

/// The number of its object.
[[nodiscard]] inline std::uint32_t object_at(const Scene& scene, const FaceRef& face) {
  const Instance* const instance = instance_at(scene, face);
  return face_at(scene, face).object + (instance != nullptr ? instance->object : 0);
}

/// Of the scene, those of all instances included.
[[nodiscard]] std::uint64_t triangle_count(const Scene& scene);

/// Sets the rows of a transform of the world, from coordinates relative to `from` to those relative
/// to `to`.
void set_rows(const glm::dmat4& world, const glm::dvec3& from, const glm::dvec3& to,
              Instance& instance);

/// Makes triangles of the part's into a mesh of the scene, which takes over the part's normals,
/// texture coordinates, materials, textures and objects, too; `part.materials` may be empty: its
/// triangles have the scene's then. The mesh's number; its coordinates are relative to
/// `part.origin`.
std::uint32_t add_mesh(Scene& scene, Scene&& part);

/// A copy of a mesh whose triangles run the other way round, their corners C, B, A; its number. For
/// mirrored instances, whose fronts stay the fronts.
std::uint32_t add_mirrored(Scene& scene, std::uint32_t mesh);

/// Makes the triangles of a part into a mesh of a scene, and adds instances of it.
class MeshInstancer {
 public:
  /// The scene must outlive this.
  MeshInstancer(Scene& scene, Scene&& part);

  /// Adds an instance by its transform to the world; the scene's origin is known. Mirrored ones
  /// have a mesh of their own. False, and none is added, where it is beyond the range of float.
  [[nodiscard]] bool add(const glm::dmat4& world, std::uint32_t object);

 private:
  Scene& scene_;
  glm::dvec3 origin_;  // of the mesh's coordinates
  std::uint32_t mesh_;
  std::uint32_t mirrored_ = kNoIndex;  // none so far
  glm::dvec3 size_{0.0};               // the largest magnitudes of its coordinates
};

/// Replaces all instances by triangles like others, of the same numbers, corners and normals.
void flatten_instances(Scene& scene);

/// What becomes of instances.
enum class InstanceMode {
  kFlatten,
  kKeep,       ///< each mesh is in memory once
  kAutomatic,  ///< kept where more than kFlattenLimit triangles would be added
};
inline constexpr std::uint64_t kFlattenLimit = 4'000'000;

/// Throws InputError, beginning with `file`, where there are about 2^31 triangles or 2^32 objects
/// or more: not all would have a number. To be asked before anything looks at all of them.
void require_numbers(const Scene& scene, const std::filesystem::path& file);

/// Flattens what is not to be kept, and in any case what emits: area lights are lists of triangles.
/// What is numbered how does not depend on `mode`. Throws as require_numbers does.
void resolve_instances(Scene& scene, InstanceMode mode, const std::filesystem::path& file);

}  // namespace raygate
