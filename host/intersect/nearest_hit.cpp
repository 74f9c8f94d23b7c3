#include "host/intersect/nearest_hit.h"

#include <algorithm>

namespace raygate {
namespace {

bool overlap(const Interval& a, const Interval& b) { return a.low <= b.high && b.low <= a.high; }

/// Whether the interval says on which side of the limit the hit is.
bool tells(const Interval& t, float limit) { return t.high < limit || t.low >= limit; }

}  // namespace

bool is_before(const Bvh& bvh, const Ray& ray, const NearestHit& hit, float limit) {
  if (limit == std::numeric_limits<float>::infinity()) return true;
  if (tells(hit.t, limit)) return hit.t.high < limit;
  return compare_hit_to_limit(ray, bvh.corners_of(hit.primitive), limit) < 0;
}

bool is_nearer(const Bvh& bvh, const Ray& ray, const NearestHit& a, const NearestHit& b) {
  if (!overlap(a.t, b.t)) return a.t.high < b.t.low;
  const int order = compare_hits(ray, bvh.corners_of(a.primitive), bvh.corners_of(b.primitive));
  return order < 0 || (order == 0 && bvh.triangle_of(a.primitive) <= bvh.triangle_of(b.primitive));
}

bool take_if_nearer(const Bvh& bvh, const Ray& ray, float limit, const NearestHit& hit,
                    NearestHit& best, IntersectCounters& counters) {
  const bool has_limit = limit != std::numeric_limits<float>::infinity();
  counters.exact_depth += has_limit && !tells(hit.t, limit);
  if (!is_before(bvh, ray, hit, limit)) return false;
  if (best.primitive == NearestHit::kNone) {
    best = hit;
    return true;
  }
  counters.exact_depth += overlap(hit.t, best.t);
  if (!is_nearer(bvh, ray, hit, best)) return false;
  const double farthest = best.t.high;
  best = hit;
  best.t.high = std::min(best.t.high, farthest);  // it is nearer than what it replaces
  return true;
}

bool resolve_doubt(const Bvh& bvh, const Ray& ray, float limit, NearestHit doubt, NearestHit& best,
                   IntersectCounters& counters) {
  const Corners& corners = bvh.corners_of(doubt.primitive);
  doubt.t = hit_distance(ray, corners);
  if (doubt.t.low >= limit || (best.primitive != NearestHit::kNone && doubt.t.low > best.t.high)) {
    return false;
  }
  ++counters.exact_inside;
  return hits_triangle(ray, corners) && take_if_nearer(bvh, ray, limit, doubt, best, counters);
}

}  // namespace raygate
