// Polygon records, four at a time.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "host/hit/polygon_record.h"

namespace raygate {

/// records[i] = make_record(origin, triangles[i]), bit for bit. The spans are of one size.
void make_records(const glm::vec3& origin, std::span<const Corners> triangles,
                  std::span<PolygonRecord> records);

}  // namespace raygate
