#include "host/intersect/core/core_intersector.h"

#include <stdexcept>
#include <string>

#include "host/base/input_error.h"
#include "host/base/measure.h"
#include "host/intersect/unit/burst_unit.h"

namespace raygate {

IntersectCounters CoreIntersector::counters() const {
  IntersectCounters counters = counters_;
  counters.hit += core_->counters();
  counters.hit.unit_tests = counters.hit.tests;
  return counters;
}

void CoreIntersector::trace(std::span<const Ray> rays, const RayQuery& query,
                            std::span<NearestHit> hits) {
  Stopwatch watch;
  sent_.clear();
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    if (!is_usable(rays[i].direction)) continue;
    if (!is_scaled(rays[i].direction)) throw_unscaled(rays[i]);
    CoreRay& sent = sent_.emplace_back();
    sent.ray = rays[i];
    sent.t_max = query.t_max_of(i);
    sent.tag = i;
    if (!query.skip_ids.empty()) sent.skip_id = image_->line_of(query.skip_ids[i]);
    if (!query.source_ids.empty()) sent.source_id = image_->line_of(query.source_ids[i]);
    // Any hit before t_max ends the search if t_max <= any_hit_before.
    sent.any_hit = !query.any_hit_before.empty() && query.any_hit_before[i] >= sent.t_max;
  }
  results_.clear();
  core_->trace(image_->lines(), sent_, results_);
  for (const CoreResult& result : results_) {
    if (result.error != CoreResult::Error::kNone) {  // the BVH in the core's memory is not valid
      throw InputError(result.error == CoreResult::Error::kMemory
                           ? "ray core's memory: no line " + std::to_string(result.line)
                           : "ray core's memory: a node is below itself, or below more than " +
                                 std::to_string(MemoryImage::kMostDepth - 1) + " others");
    }
    const bool is_doubt = result.kind == CoreResult::Kind::kDoubt;
    if (result.tag >= rays.size() ||
        ((is_doubt || result.found) &&
         image_->primitive_at(result.triangle) == MemoryImage::kNoTriangle) ||
        (core_->is_exact() && is_doubt)) {
      throw std::runtime_error("ray core: found triangle " + std::to_string(result.triangle) +
                               " for ray " + std::to_string(result.tag) +
                               ", expected some that it was given");
    }
    if (!query.work.empty()) {
      query.work[result.tag].tests += is_doubt ? 0 : result.tests;
      query.work[result.tag].doubts += is_doubt;
    }
    if (!is_doubt && !result.found) continue;
    const Ray& ray = rays[result.tag];
    NearestHit& best = hits[result.tag];
    NearestHit hit{.primitive = image_->primitive_at(result.triangle)};
    if (!is_doubt) hit.t = hit_distance(ray, bvh_.corners_of(hit.primitive));
    if (core_->is_exact()) {
      best = hit;
    } else {
      take_if_nearest(bvh_, ray, query.t_max_of(result.tag), hit, !is_doubt, best, counters_);
    }
  }
  for (std::size_t i = 0; i < rays.size() && query.with_points; ++i) {
    if (hits[i].primitive == NearestHit::kNone) continue;
    const PolygonRecord plane = make_plane(rays[i].origin, bvh_.corners_of(hits[i].primitive));
    set_point(plane, rays[i].direction, hits[i]);
    ++counters_.hit.plane_tests;
  }
  counters_.seconds += watch.lap();
}

}  // namespace raygate
