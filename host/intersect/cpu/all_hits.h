// All hits of a ray, in exact order.
#pragma once

#include <vector>

#include "host/intersect/intersector.h"

namespace raygate {

/// Replaces `hits` by all hits of `ray` with t < t_max, near before far; ties in t: lower triangle
/// index first. `t_max` is positive, +infinity for all. The direction is scaled; one that is not
/// usable hits nothing. `point` and `point_error` of the hits are not valid.
void all_hits(const Bvh& bvh, const Ray& ray, float t_max, std::vector<NearestHit>& hits,
              RayWork& work);

}  // namespace raygate
