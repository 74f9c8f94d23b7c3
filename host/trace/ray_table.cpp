#include "host/trace/ray_table.h"

#include <algorithm>
#include <cmath>

namespace raygate {

void RayTable::clear(std::uint64_t its_first) {
  first = its_first;
  rays.clear();
  limits.clear();
  exponents.clear();
  rounded = 0;
}

const char* RayTable::add(const glm::dvec3& origin, const glm::dvec3& direction, double limit,
                          const glm::dvec3& scene_origin) {
  const auto is_finite = [](const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  if (!is_finite(origin) || !is_finite(direction)) {
    return "found inf or nan in origin or direction, expected finite numbers";
  }
  if (!(limit > 0.0)) return "found a limit that is not above 0, expected one, or inf";
  if (largest(origin - scene_origin) > kMostCoordinate) {
    return "found an origin farther than 2^126 from the scene, expected a nearer one";
  }
  const RecentredPosition start = recentred(origin, scene_origin);
  Ray ray{.origin = start.position};
  int exponent = 0;
  if (direction != glm::dvec3(0.0)) {
    ray.direction = scaled_direction(direction);
    // A power of two, but for the rounding of the direction.
    exponent = static_cast<int>(
        std::lround(std::log2(largest(glm::dvec3(ray.direction))) - std::log2(largest(direction))));
  }
  const auto as_given = [&](float x) { return std::ldexp(double{x}, -exponent); };
  const glm::dvec3 kept(as_given(ray.direction.x), as_given(ray.direction.y),
                        as_given(ray.direction.z));
  const double scaled_limit = std::ldexp(limit, -exponent);
  const float float_limit =
      std::max(static_cast<float>(scaled_limit), std::numeric_limits<float>::denorm_min());
  rounded += start.error != 0.0 || kept != direction ||
             (double{float_limit} != scaled_limit && std::isfinite(float_limit));
  rays.push_back(ray);
  limits.push_back(float_limit);
  exponents.push_back(exponent);
  return nullptr;
}

}  // namespace raygate
