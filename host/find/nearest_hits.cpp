#include "host/find/nearest_hits.h"

#include <algorithm>
#include <cmath>

#include "host/stopwatch.h"

namespace raygate {

bool NearestHits::offer(std::uint32_t number, const Ray& ray, const SureHit& hit) {
  return take_if_nearer(number, ray, {hit.tag, hit.point, hit.t});
}

bool NearestHits::offer(std::uint32_t number, const Ray& ray, const Doubt& doubt) {
  const Corners& corners = bvh_.corners_of(doubt.tag);
  const NearestHit& best = nearest_[number];
  Stopwatch watch;
  // Where it is hit, if at all, is asked first: as a rule that takes doubles alone.
  const Interval t = hit_distance(ray, corners);
  const bool too_far = (!limits_.empty() && t.low >= limits_[number]) ||
                       (best.slot != NearestHit::kNone && t.low > best.t.high);
  counters_.exact_inside += !too_far;
  const bool hit = !too_far && hits_triangle(ray, corners);
  counters_.seconds += watch.lap();
  return hit && take_if_nearer(number, ray, {doubt.tag, doubt.point, t});
}

bool NearestHits::is_before(const NearestHit& hit, const Ray& ray, float limit) {
  if (!std::isfinite(limit) || hit.t.high < limit) return true;
  if (hit.t.low >= limit) return false;
  ++counters_.exact_depth;
  Stopwatch watch;
  const int order = compare_hit_to_limit(ray, bvh_.corners_of(hit.slot), limit);
  counters_.seconds += watch.lap();
  return order < 0;
}

bool NearestHits::take_if_nearer(std::uint32_t number, const Ray& ray, const NearestHit& hit) {
  NearestHit& best = nearest_[number];
  if (!limits_.empty() && !is_before(hit, ray, limits_[number])) return false;
  if (best.slot != NearestHit::kNone && hit.t.high >= best.t.low) {
    if (hit.t.low > best.t.high) return false;
    ++counters_.exact_depth;
    Stopwatch watch;
    const int order = compare_hits(ray, bvh_.corners_of(hit.slot), bvh_.corners_of(best.slot));
    counters_.seconds += watch.lap();
    if (order > 0) return false;
    if (order == 0 && bvh_.triangle_of(hit.slot) > bvh_.triangle_of(best.slot)) return false;
  }
  const double farthest = best.slot != NearestHit::kNone ? best.t.high : hit.t.high;
  best = hit;
  best.t.high = std::min(best.t.high, farthest);  // it is nearer than what it replaces
  return true;
}

}  // namespace raygate
