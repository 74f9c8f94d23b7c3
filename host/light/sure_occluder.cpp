#include "host/light/sure_occluder.h"

#include <algorithm>
#include <cmath>

#include "host/scene/material_lookup.h"

namespace raygate {
namespace {

constexpr double kMostStray = 0x1p-16, kRoom = 0x1p-15;
constexpr double kBeforeLimit = 1.0 - 0x1p-10;

}  // namespace

bool is_sure_occluder(const Scene& scene, const Bvh& bvh, const SurfaceHit& place, float t_max) {
  const Corners corners = bvh.corners_of(place.primitive);
  const glm::dvec3 origin(place.ray->origin), direction(place.ray->direction);
  const double length = glm::length(direction);
  const glm::dvec3 along = direction / length;
  glm::dvec3 from_origin[3], area, edge;  // area[k]: seen along the ray, opposite corner k
  for (int k = 0; k < 3; ++k) from_origin[k] = glm::dvec3(corners[k]) - origin;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 side = from_origin[(k + 2) % 3] - from_origin[(k + 1) % 3];
    area[k] = glm::dot(along, glm::cross(from_origin[(k + 1) % 3], side));
    edge[k] = glm::length(glm::cross(along, side));
  }
  const double whole = area[0] + area[1] + area[2];
  const glm::dvec3 weights = area / whole;
  glm::dvec3 depth;
  for (int k = 0; k < 3; ++k) depth[k] = glm::dot(along, from_origin[k]);
  const double way = glm::dot(weights, depth);
  const double size = std::max(largest(origin), largest(origin + way * along));
  // What weights change by within the room.
  const glm::dvec3 change = edge * (kRoom * size / std::abs(whole));
  if (!(weights.x > change.x && weights.y > change.y && weights.z > change.z)) return false;
  const double slope =
      change.y * std::abs(depth.y - depth.x) + change.z * std::abs(depth.z - depth.x);
  if (!(way + slope < kBeforeLimit * (static_cast<double>(t_max) * length))) return false;
  return is_nowhere_masked(scene, *place.face, weights, change);
}

bool strays_from(const glm::vec3& from, const glm::dvec3& way, const glm::vec3& point) {
  const double size = std::max(largest(from), largest(point));
  const double distance =
      glm::length(glm::cross(glm::dvec3(point) - glm::dvec3(from), way)) / glm::length(way);
  return !(distance <= kMostStray * size);
}

}  // namespace raygate
