#include "host/variants/variant_units.h"

#include <cassert>

namespace raygate {

template class BasicReferenceBurstUnit<Arithmetic>;

void VariantPlaneUnit::intersect(std::span<const PlaneTest> tests, std::span<glm::vec3> points) {
  assert(tests.size() == points.size());
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const glm::vec3 direction = math_.read(tests[i].direction),
                    normal = math_.read(tests[i].normal);
    const float d = math_.read(tests[i].d);
    // The accumulator starts from +0.
    float dot = math_.add(0.0f, math_.multiply(normal.x, direction.x));
    dot = math_.add(dot, math_.multiply(normal.y, direction.y));
    dot = math_.add(dot, math_.multiply(normal.z, direction.z));
    for (int k = 0; k < 3; ++k) {
      points[i][k] = math_.divide(math_.multiply(d, direction[k]), dot);
    }
  }
}

}  // namespace raygate
