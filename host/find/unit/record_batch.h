// Polygon records, four at a time.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "host/find/unit/polygon_record.h"

namespace raygate {

/// records[i] = make_record(origin, triangles[i]), bit for bit. The spans are of one size.
void make_records(const glm::vec3& origin, std::span<const Corners> triangles,
                  std::span<PolygonRecord> records);

/// How many planes are made at once.
inline constexpr int kPlanes = 4;

/// A triangle, and whence it is seen.
struct PlaneView {
  const glm::vec3* origin;
  const Corners* triangle;
};

/// planes[i] = make_plane(*views[i].origin, *views[i].triangle), bit for bit.
void make_planes(const std::array<PlaneView, kPlanes>& views,
                 std::array<PolygonRecord, kPlanes>& planes);

}  // namespace raygate
