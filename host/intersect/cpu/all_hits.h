// Every triangle that a ray hits, in exact order.
#pragma once

#include <vector>

#include "host/intersect/intersector.h"

namespace raygate {

/// Replaces `hits` by all hits of `ray` with t < limit, near before far; of equally far ones the
/// one of the lower triangle comes first. `limit` is positive, +infinity for none; the direction
/// scaled, or not usable, and then nothing is hit. A hit's `point` and `point_error` say nothing.
void all_hits(const Bvh& bvh, const Ray& ray, float limit, std::vector<NearestHit>& hits,
              RayWork& work);

}  // namespace raygate
