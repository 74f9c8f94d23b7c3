// Makes polygon records and planes, four at a time.
#pragma once

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

/// N and d of polygon records, as make_plane has them, lane by lane.
struct Planes {
  alignas(16) float words[4][kPlanes];
};

/// Lane i is make_plane(views.origins[i], views.triangles[i]), bit for bit.
void make_planes(const PlaneViews& views, Planes& planes);

}  // namespace raygate
