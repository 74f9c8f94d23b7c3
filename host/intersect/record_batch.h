// Makes polygon records and planes, four at a time.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>

#include "host/intersect/polygon_record.h"

namespace raygate {

/// records[i] = make_record(origin, triangles[i]), bit for bit. The spans are of one size.
void make_records(const glm::vec3& origin, std::span<const Corners> triangles,
                  std::span<PolygonRecord> records);

/// How many planes are made at once.
inline constexpr int kPlanes = 4;

/// Triangles, and whence they are seen, lane by lane.
struct PlaneViews {
  alignas(16) float origins[3][kPlanes];
  alignas(16) float corners[3][3][kPlanes];  ///< [corner][axis]

  void set(std::size_t i, const glm::vec3& origin, const Corners& triangle) {
    for (int k = 0; k < 3; ++k) {
      origins[k][i] = origin[k];
      for (int v = 0; v < 3; ++v) corners[v][k][i] = triangle[v][k];
    }
  }
  [[nodiscard]] glm::vec3 origin(std::size_t i) const {
    return {origins[0][i], origins[1][i], origins[2][i]};
  }
  [[nodiscard]] Corners triangle(std::size_t i) const {
    Corners triangle;
    for (int v = 0; v < 3; ++v) {
      for (int k = 0; k < 3; ++k) triangle[v][k] = corners[v][k][i];
    }
    return triangle;
  }
};

/// N and d of polygon records, lane by lane.
struct Planes {
  alignas(16) float words[4][kPlanes];

  /// As make_plane has it.
  [[nodiscard]] PolygonRecord record(std::size_t i) const {
    PolygonRecord record;
    record.normal = {words[0][i], words[1][i], words[2][i]};
    record.d = words[3][i];
    return record;
  }
};

/// planes.record(i) = make_plane(views.origin(i), views.triangle(i)), bit for bit.
void make_planes(const PlaneViews& views, Planes& planes);

}  // namespace raygate
