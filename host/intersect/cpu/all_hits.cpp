#include "host/intersect/cpu/all_hits.h"

#include <algorithm>
#include <bit>

#include "host/bvh/packet_bounds.h"
#include "host/bvh/traversal.h"
#include "host/intersect/cpu/quad_test.h"

namespace raygate {
namespace {

/// What the tree asks (see next_leaf).
struct LineVisitor {
  Beam beam;
  float cutoff;

  RAYGATE_INLINE bool goes_on(float entry, Whole) const { return entry <= cutoff; }
  RAYGATE_INLINE LaneMask meet(const Bvh::Node& node, Whole, FloatLanes& entry) const {
    return meet_children(beam, node, cutoff, entry);
  }
  RAYGATE_INLINE static Whole rays_at(int) { return {}; }
};

/// The slots of a leaf's triangles that the ray hits at some t > 0.
RAYGATE_INLINE void test_leaf(const Bvh& bvh, const Ray& ray, const ShearedRay& sheared,
                              const Bvh::Child& leaf, std::vector<NearestHit>& hits,
                              RayWork& work) {
  QuadVerdict verdict;
  Bvh::LeafRoom room;
  test_quad(sheared, bvh.corners_of(leaf, room), leaf.count, verdict);
  work.tests += leaf.count;
  work.doubts += static_cast<std::uint32_t>(std::popcount(verdict.doubt));
  for (LaneMask open = verdict.hit | verdict.level | verdict.doubt; open != 0; open &= open - 1) {
    const int i = std::countr_zero(open);
    const std::uint32_t slot = leaf.first + static_cast<std::uint32_t>(i);
    const Corners corners = bvh.corners_of(slot);
    const bool is_hit = (verdict.doubt >> i & 1) != 0   ? hits_triangle(ray, corners)
                        : (verdict.level >> i & 1) != 0 ? is_ahead(ray, corners)
                                                        : true;
    if (is_hit) hits.push_back({.slot = slot, .t = hit_distance(ray, corners)});
  }
}

}  // namespace

void all_hits(const Bvh& bvh, const Ray& ray, float limit, std::vector<NearestHit>& hits,
              RayWork& work) {
  hits.clear();
  if (!is_usable(ray.direction)) return;
  if (!is_scaled(ray.direction)) refuse_unscaled(ray);
  in_vectors([&](auto) RAYGATE_BODY {
    const ShearedRay sheared(ray);
    const LineVisitor visitor{Beam(ray.origin, ray.direction), cutoff_beyond(limit)};
    WalkStack<Whole> stack({});
    Waiting<Whole> leaf;
    while (next_leaf(bvh, visitor, stack, leaf)) {
      test_leaf(bvh, ray, sheared, leaf.child, hits, work);
    }
  });
  std::erase_if(hits, [&](const NearestHit& hit) { return !is_before(bvh, ray, hit, limit); });
  std::ranges::sort(hits, [&](const NearestHit& a, const NearestHit& b) {
    return a.slot != b.slot && is_nearer(bvh, ray, a, b);
  });
}

}  // namespace raygate
