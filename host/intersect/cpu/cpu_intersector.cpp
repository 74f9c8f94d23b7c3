#include "host/intersect/cpu/cpu_intersector.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "host/base/stopwatch.h"
#include "host/bvh/bvh_view.h"
#include "host/bvh/packet_traversal.h"
#include "host/bvh/traversal.h"
#include "host/intersect/cpu/packet_intersector.h"
#include "host/intersect/cpu/quad_test.h"
#include "host/intersect/cpu/single_ray_intersector.h"

namespace raygate {

void CpuIntersector::intersect(std::span<const Ray> rays, const RayQuery& query,
                               std::span<NearestHit> hits) {
  assert(hits.size() == rays.size());
  Stopwatch watch;
  clear(query, hits);
  HitCounters& counters = counters_.hit;
  const HitCounters before = counters;
  if (query.common_origin && query.culling && !rays.empty()) {
    PacketIntersector(bvh_, counters_).trace(rays, query, hits);
  } else {
    SingleRayIntersector(bvh_, counters_).trace(rays, query, hits);
  }
  counters.misses += (counters.tests - before.tests) - (counters.hits - before.hits) -
                     (counters.edge_doubts - before.edge_doubts);
  counters_.hit_tests += watch.lap();
}

namespace {

/// Visitor of the traversal (see next_leaf).
struct LineVisitor {
  PacketBounds bounds;
  float cutoff;

  RAYGATE_INLINE bool should_visit(float entry, SingleRay) const { return entry <= cutoff; }
  RAYGATE_INLINE LaneMask intersect_boxes(const Bvh::Node& node, SingleRay,
                                          FloatLanes& entry) const {
    return intersect_children(bounds, node, cutoff, entry);
  }
  RAYGATE_INLINE static SingleRay rays_of_child(int) { return {}; }
};

/// Appends the primitives of a leaf that the ray hits at t > 0.
RAYGATE_INLINE void test_leaf(const Bvh& bvh, const BvhView& tree, const Ray& ray,
                              const ShearedRay& sheared, const Bvh::Child& leaf,
                              std::vector<NearestHit>& hits, RayWork& work) {
  QuadVerdict verdict;
  Bvh::LeafRoom room;
  test_quad(sheared, tree.corners_of(leaf, room), leaf.count, verdict);
  work.tests += leaf.count;
  work.doubts += static_cast<std::uint32_t>(std::popcount(verdict.doubt));
  for (LaneMask open = verdict.hit | verdict.level | verdict.doubt; open != 0; open &= open - 1) {
    const int i = std::countr_zero(open);
    const std::uint32_t primitive = leaf.first + static_cast<std::uint32_t>(i);
    const Corners corners = bvh.corners_of(primitive);
    const bool is_hit = (verdict.doubt >> i & 1) != 0   ? hits_triangle(ray, corners)
                        : (verdict.level >> i & 1) != 0 ? is_ahead(ray, corners)
                                                        : true;
    if (is_hit) hits.push_back({.primitive = primitive, .t = hit_distance(ray, corners)});
  }
}

}  // namespace

void all_hits(const Bvh& bvh, const Ray& ray, float t_max, std::vector<NearestHit>& hits,
              RayWork& work) {
  hits.clear();
  if (!is_usable(ray.direction)) return;
  if (!is_scaled(ray.direction)) throw_unscaled(ray);
  in_vectors([&](auto) RAYGATE_BODY {
    const ShearedRay sheared(ray);
    const LineVisitor visitor{PacketBounds(ray.origin, ray.direction), cutoff_beyond(t_max)};
    TraversalStack<SingleRay> stack({});
    StackEntry<SingleRay> leaf;
    const BvhView tree(bvh);
    while (next_leaf(tree, visitor, stack, leaf)) {
      test_leaf(bvh, tree, ray, sheared, leaf.child, hits, work);
    }
  });
  std::erase_if(hits, [&](const NearestHit& hit) { return !is_before(bvh, ray, hit, t_max); });
  std::ranges::sort(hits, [&](const NearestHit& a, const NearestHit& b) {
    return a.primitive != b.primitive && is_nearer(bvh, ray, a, b);
  });
}

}  // namespace raygate
