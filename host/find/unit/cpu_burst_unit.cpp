#include "host/find/unit/cpu_burst_unit.h"

namespace raygate {

template class BurstUnitTwin<Binary32>;

HitDistance hit_distance(const PolygonRecord& record, const glm::vec3& direction) {
  return CpuBurstUnit().distance(record, direction);
}

glm::vec3 plane_point(const PolygonRecord& record, const glm::vec3& direction) {
  return CpuBurstUnit().point(record, direction);
}

}  // namespace raygate
