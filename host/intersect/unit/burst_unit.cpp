#include "host/intersect/unit/burst_unit.h"

#include <bit>

namespace raygate {

bool operator==(const BurstHit& a, const BurstHit& b) {
  const auto same = [](float x, float y) {
    return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
  };
  return a.bundle == b.bundle && a.lane == b.lane && a.record == b.record && same(a.t, b.t) &&
         a.t_error == b.t_error && same(a.point.x, b.point.x) && same(a.point.y, b.point.y) &&
         same(a.point.z, b.point.z);
}

}  // namespace raygate
