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

/// Triangles, and whence they are seen.
struct PlaneViews {
  glm::vec3 origins[kPlanes];
  Corners triangles[kPlanes];
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

/// planes.record(i) = make_plane(views.origins[i], views.triangles[i]), bit for bit.
void make_planes(const PlaneViews& views, Planes& planes);

}  // namespace raygate
