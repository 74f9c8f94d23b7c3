#include "host/trace/hit_place.h"

#include <algorithm>

namespace raygate {

HitPlace place_of_hit(const Ray& ray, const Corners& corners) {
  const Interval t = hit_distance(ray, corners);
  const glm::dvec3 direction(ray.direction);
  double weights[3];
  for (int k = 0; k < 3; ++k) {
    weights[k] =
        glm::dot(direction, edge_normal(ray.origin, corners[(k + 1) % 3], corners[(k + 2) % 3]));
  }
  const double sum = weights[0] + weights[1] + weights[2];
  const auto within = [](double share, double most) {
    return std::max(0.0, std::min(share, most));
  };
  const double u = within(weights[1] / sum, 1.0);
  return {0.5 * (t.low + t.high), u, within(weights[2] / sum, 1.0 - u)};
}

}  // namespace raygate
