#include "host/intersect/cpu/cpu_intersector.h"

#include <algorithm>
#include <bit>

#include "host/base/measure.h"
#include "host/bvh/traversal.h"
#include "host/intersect/cpu/quad_test.h"

namespace raygate {

void CpuIntersector::trace(std::span<const Ray> rays, const RayQuery& query,
                           std::span<NearestHit> hits) {
  Stopwatch watch;
  HitCounters& counters = counters_.hit;
  const HitCounters before = counters;
  if (query.common_origin && !rays.empty()) {
    trace_packets(bvh_, rays, query, hits, counters_);
  } else {
    trace_single_rays(bvh_, rays, query, hits, counters_);
  }
  counters.misses += (counters.tests - before.tests) - (counters.hits - before.hits) -
                     (counters.edge_doubts - before.edge_doubts);
  if (query.with_points) {
    counters.plane_tests += write_points(bvh_, rays, query.common_origin, hits);
  }
  counters_.hit_tests += watch.lap();
}

void all_hits(const Bvh& bvh, const Ray& ray, float t_max, std::vector<NearestHit>& hits,
              RayWork& work) {
  hits.clear();
  if (!is_usable(ray.direction)) return;
  if (!is_scaled(ray.direction)) throw_unscaled(ray);
  in_vectors([&](auto) RAYGATE_BODY {
    const ShearedRay sheared(ray);
    const PacketBounds bounds(ray.origin, ray.direction);
    const float cutoff = cutoff_beyond(t_max);
    const BvhView tree(bvh);
    const auto boxes = [&](const Bvh::Node& node) RAYGATE_BODY {
      FloatLanes entry;
      return intersect_children(bounds, node, cutoff, entry);
    };
    const auto take_hits = [&](const Bvh::Child& leaf) RAYGATE_BODY {
      QuadVerdict verdict;
      Bvh::LeafRoom room;
      test_quad(sheared, tree.corners_of(leaf, room), leaf.count, verdict);
      work.tests += leaf.count;
      work.doubts += static_cast<std::uint32_t>(std::popcount(verdict.doubt));
      for (LaneMask open = verdict.hit | verdict.level | verdict.doubt; open != 0;
           open &= open - 1) {
        const int i = std::countr_zero(open);
        const std::uint32_t primitive = leaf.first + static_cast<std::uint32_t>(i);
        const Corners corners = bvh.corners_of(primitive);
        const bool is_hit = (verdict.doubt >> i & 1) != 0   ? hits_triangle(ray, corners)
                            : (verdict.level >> i & 1) != 0 ? is_ahead(ray, corners)
                                                            : true;
        if (is_hit) hits.push_back({.primitive = primitive, .t = hit_distance(ray, corners)});
      }
      return false;
    };
    any_leaf(bvh, boxes, take_hits);
  });
  std::erase_if(hits, [&](const NearestHit& hit) { return !is_before(bvh, ray, hit, t_max); });
  std::ranges::sort(hits, [&](const NearestHit& a, const NearestHit& b) {
    return a.primitive != b.primitive && is_nearer(bvh, ray, a, b);
  });
}

}  // namespace raygate
