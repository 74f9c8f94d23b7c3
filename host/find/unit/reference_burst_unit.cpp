#include "host/find/unit/reference_burst_unit.h"

namespace raygate {

template class BasicReferenceBurstUnit<Binary32>;

HitDistance hit_distance(const PolygonRecord& record, const glm::vec3& direction) {
  return ReferenceBurstUnit().distance(record, direction);
}

glm::vec3 plane_point(const PolygonRecord& record, const glm::vec3& direction) {
  return ReferenceBurstUnit().point(record, direction);
}

}  // namespace raygate
