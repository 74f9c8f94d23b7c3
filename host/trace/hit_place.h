// Where on its triangle a ray hits.
#pragma once

#include "host/exact/exact.h"

namespace raygate {

/// Of a hit.
struct HitPlace {
  double t;     ///< the middle of its interval: off by at most 2^-33 of itself
  double u, v;  ///< P = (1 - u - v) A + u B + v C; none of the three is negative, nor -0
};

/// The triangle must be hit.
[[nodiscard]] HitPlace place_of_hit(const Ray& ray, const Corners& corners);

}  // namespace raygate
