// Instances of meshes: transforms, construction and flattening.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>

#include "host/base/vectors.h"
#include "host/scene/scene.h"

namespace raygate {

/// Computes one coordinate of a transformed point, before rounding to float, from a row of
/// Instance::rows. T is double or a SIMD vector. All callers share this sequence of operations.
template <class T>
RAYGATE_INLINE void transform_coordinate(const double (&row)[4], const T (&point)[3], T& result) {
  result = ((row[0] * point[0] + row[1] * point[1]) + row[2] * point[2]) + row[3];
}

/// Returns a mesh position transformed by an instance and rounded to float, for all intersectors.
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

/// Returns the unit normal of an instance for a normal of its mesh, or 0 if the transform collapses
/// the normal. Uses the cofactor matrix, a multiple of the inverse transpose that always exists.
[[nodiscard]] inline glm::vec3 transform_normal(const Instance& instance, const glm::vec3& normal) {
  glm::dvec3 row[3];
  for (int k = 0; k < 3; ++k) {
    row[k] = {instance.rows[k][0], instance.rows[k][1], instance.rows[k][2]};
  }
  const glm::dvec3 n(normal);
  const glm::dvec3 turned(glm::dot(glm::cross(row[1], row[2]), n),
                          glm::dot(glm::cross(row[2], row[0]), n),
                          glm::dot(glm::cross(row[0], row[1]), n));
  // Scaling first keeps the squares of tiny and huge components in range.
  const double size = std::max({std::abs(turned.x), std::abs(turned.y), std::abs(turned.z)});
  if (!(size > 0.0 && std::isfinite(size))) return glm::vec3(0.0f);
  return glm::vec3(glm::normalize(turned / size));
}

/// Returns the tangent of an instance for a tangent of its mesh, in the format of Scene::tangents.
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

/// Location where a triangle is stored: in the scene or in an instance's mesh.
struct FaceRef {
  std::uint32_t instance = kNoIndex;  ///< index into Scene::instances; kNoIndex: none
  /// Index into Scene::triangles or into the triangles of the instance's mesh.
  std::uint32_t triangle = 0;
};

[[nodiscard]] inline const Triangle& face_at(const Scene& scene, const FaceRef& face) {
  if (face.instance == kNoIndex) [[likely]]
    return scene.triangles[face.triangle];
  return scene.meshes[scene.instances[face.instance].mesh].triangles[face.triangle];
}

/// Returns a triangle's instance, or nullptr if the triangle is one of Scene::triangles.
[[nodiscard]] inline const Instance* instance_at(const Scene& scene, const FaceRef& face) {
  return face.instance == kNoIndex ? nullptr : &scene.instances[face.instance];
}

/// Returns a triangle's object index.
[[nodiscard]] inline std::uint32_t object_at(const Scene& scene, const FaceRef& face) {
  const Instance* const instance = instance_at(scene, face);
  return face_at(scene, face).object + (instance != nullptr ? instance->object : 0);
}

/// Returns the number of triangles of the scene, including those of all instances.
[[nodiscard]] std::uint64_t triangle_count(const Scene& scene);

/// Sets instance.rows from a world transform. The mesh's origin is `from`, the scene's is `to`.
void set_rows(const glm::dmat4& world, const glm::dvec3& from, const glm::dvec3& to,
              Instance& instance);

/// Moves the triangles, normals, texture coordinates, materials and textures of `part` into a new
/// mesh of the scene and returns the mesh index. Object indices do not change. Mesh coordinates are
/// relative to `part.origin`. If `part.materials` is empty, material indices are the scene's.
std::uint32_t add_mesh(Scene& scene, Scene&& part);

/// Adds a copy of a mesh with reversed winding (corners C, B, A) and returns the copy's index.
/// Mirrored instances use the copy to keep their front sides.
std::uint32_t add_mirrored(Scene& scene, std::uint32_t mesh);

/// Adds a part to a scene as a mesh, and instances of this mesh.
class MeshInstancer {
 public:
  /// `scene` must outlive this object.
  MeshInstancer(Scene& scene, Scene&& part);

  /// Adds an instance; `world` is its transform to the world. Scene::origin must be set. Mirrored
  /// instances share a mirrored mesh. Returns false and adds none if a coordinate may overflow.
  [[nodiscard]] bool add(const glm::dmat4& world, std::uint32_t object);

 private:
  Scene& scene_;
  glm::dvec3 origin_;  // of the mesh's coordinates
  std::uint32_t mesh_;
  std::uint32_t mirrored_ = kNoIndex;  // kNoIndex until a mirrored instance is added
  glm::dvec3 size_{0.0};               // largest magnitudes of the mesh's coordinates
};

/// Policy for instances in a loaded scene.
enum class InstanceMode {
  kFlatten,
  kKeep,       ///< instances share their mesh
  kAutomatic,  ///< flattened unless this adds more than kFlattenLimit triangles
};
inline constexpr std::uint64_t kFlattenLimit = 4'000'000;

/// Throws InputError, naming `file`, if there are about 2^31 triangles or more: too many for the
/// index types. Call this before any loop over the triangles of all instances.
void require_numbers(const Scene& scene, const std::filesystem::path& file);

/// Flattens instances as `mode` requires. Always flattens emissive instances, because area lights
/// are lists of triangles. Indices, corners and normals do not depend on `mode`. Throws InputError
/// as require_numbers() does.
void resolve_instances(Scene& scene, InstanceMode mode, const std::filesystem::path& file);

}  // namespace raygate
