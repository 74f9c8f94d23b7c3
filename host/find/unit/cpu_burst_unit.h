// The pipelined unit's twin in the machine's own float arithmetic.
#pragma once

#include "host/exact/binary32.h"
#include "host/find/unit/burst_unit_twin.h"

namespace raygate {

extern template class BurstUnitTwin<Binary32>;
using CpuBurstUnit = BurstUnitTwin<Binary32>;

/// As BurstUnitTwin::distance, in binary32.
[[nodiscard]] HitDistance hit_distance(const PolygonRecord& record, const glm::vec3& direction);

/// As BurstUnitTwin::point, in binary32.
[[nodiscard]] glm::vec3 plane_point(const PolygonRecord& record, const glm::vec3& direction);

}  // namespace raygate
