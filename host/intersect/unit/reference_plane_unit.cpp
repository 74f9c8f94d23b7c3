#include "host/intersect/unit/reference_plane_unit.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace raygate {
namespace {

/// The hardware has one NaN; this machine's carries the sign and payload of an operand.
float canonical(float x) { return std::isnan(x) ? std::bit_cast<float>(0x7FC00000u) : x; }

}  // namespace

void ReferencePlaneUnit::intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) {
  assert(tests.size() == points.size());
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const auto& [direction, normal, d] = tests[i];
    // The accumulator starts from +0: it turns a first product of -0 into +0.
    float dot = 0.0f + normal.x * direction.x;
    dot = dot + normal.y * direction.y;
    dot = dot + normal.z * direction.z;
    for (int k = 0; k < 3; ++k) points[i][k] = canonical((d * direction[k]) / dot);
  }
}

}  // namespace raygate
