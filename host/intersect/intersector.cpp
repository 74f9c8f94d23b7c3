#include "host/intersect/intersector.h"

#include <cstdio>
#include <stdexcept>

namespace raygate {

void throw_unscaled(const Ray& ray) {
  const glm::vec3& d = ray.direction;
  char text[160];
  std::snprintf(text, sizeof text,
                "direction (%g, %g, %g): found unscaled, expected a largest component in [1, 2)",
                d.x, d.y, d.z);
  throw std::invalid_argument(text);
}

}  // namespace raygate
