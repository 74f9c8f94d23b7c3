#include "host/intersect/unit/reference_burst_unit.h"

namespace raygate {

template class BasicReferenceBurstUnit<Binary32>;

HitDistance hit_distance(const PolygonRecord& record, const glm::vec3& direction) {
  return ReferenceBurstUnit().distance(record, direction);
}

UnitPoint plane_point(const PolygonRecord& record, const glm::vec3& direction) {
  return {ReferenceBurstUnit().point(record, direction), point_error(record, direction)};
}

float point_error(const PolygonRecord& record, const glm::vec3& direction,
                  std::optional<std::uint32_t> grazing) {
  const auto v = std::bit_cast<std::int32_t>(Binary32::dot(record.normal, direction));
  const std::int32_t g =
      grazing ? static_cast<std::int32_t>(*grazing) : grazing_of(largest_field(record.normal), v);
  return std::bit_cast<float>(point_error_of(std::bit_cast<std::int32_t>(record.d), v, g));
}

}  // namespace raygate
