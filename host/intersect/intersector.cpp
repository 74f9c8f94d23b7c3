#include "host/intersect/intersector.h"

#include <algorithm>
#include <cassert>

namespace raygate {
namespace {

bool overlap(const Interval& a, const Interval& b) { return a.low <= b.high && b.low <= a.high; }

/// Returns whether the interval decides on which side of t_max the hit is.
bool tells(const Interval& t, double t_max) { return t.high < t_max || t.low >= t_max; }

}  // namespace

void Intersector::nearest(std::span<const Ray> rays, const RayQuery& query,
                          std::span<NearestHit> hits) {
  assert(hits.size() == rays.size());
  for (NearestHit& hit : hits) hit.primitive = NearestHit::kNone;  // other members are not valid
  std::ranges::fill(query.work, RayWork{});
  trace(rays, query, hits);
}

void throw_unscaled(const Ray& ray) {
  const glm::vec3& d = ray.direction;
  char text[160];
  std::snprintf(text, sizeof text,
                "direction (%g, %g, %g): found unscaled, expected a largest component in [1, 2)",
                d.x, d.y, d.z);
  throw std::invalid_argument(text);
}

bool is_before(const Bvh& bvh, const ExactRay& ray, const NearestHit& hit, double t_max) {
  if (t_max > std::numeric_limits<float>::max()) return true;
  if (tells(hit.t, t_max)) return hit.t.high < t_max;
  return compare_hit_to_limit(ray, bvh.corners_of(hit.primitive), t_max) < 0;
}

bool is_nearer(const Bvh& bvh, const ExactRay& ray, const NearestHit& a, const NearestHit& b) {
  if (!overlap(a.t, b.t)) return a.t.high < b.t.low;
  const int order = compare_hits(ray, bvh.corners_of(a.primitive), bvh.corners_of(b.primitive));
  return order < 0 || (order == 0 && bvh.triangle_of(a.primitive) <= bvh.triangle_of(b.primitive));
}

bool take_if_nearest(const Bvh& bvh, const ExactRay& ray, float t_max, NearestHit hit, bool is_sure,
                     NearestHit& best, IntersectCounters& counters) {
  const bool is_first = best.primitive == NearestHit::kNone;
  // Hits of two triangles with equal corners need no comparison of distances.
  if (!is_first && is_sure &&
      bvh.float_corners_of(hit.primitive) == bvh.float_corners_of(best.primitive) &&
      bvh.corners_of(hit.primitive) == bvh.corners_of(best.primitive)) {
    if (bvh.triangle_of(hit.primitive) > bvh.triangle_of(best.primitive)) return false;
    best.primitive = hit.primitive;
    return true;
  }
  if (!is_sure) {
    const Corners corners = bvh.corners_of(hit.primitive);
    hit.t = hit_distance(ray, corners);
    if (hit.t.low >= t_max || (!is_first && hit.t.low > best.t.high)) return false;
    ++counters.exact_inside;
    if (!hits_triangle(ray, corners)) return false;
  }
  const bool has_limit = t_max != std::numeric_limits<float>::infinity();
  counters.exact_depth += has_limit && !tells(hit.t, t_max);
  if (!is_before(bvh, ray, hit, t_max)) return false;
  if (!is_first) {
    counters.exact_depth += overlap(hit.t, best.t);
    if (!is_nearer(bvh, ray, hit, best)) return false;
    hit.t.high = std::min(hit.t.high, best.t.high);  // because `hit` is nearer than `best`
  }
  best = hit;
  return true;
}

}  // namespace raygate
