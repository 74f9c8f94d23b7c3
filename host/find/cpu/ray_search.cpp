#include "host/find/cpu/ray_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "host/find/cpu/quad_test.h"
#include "host/find/unit/record_batch.h"
#include "host/find/unit/reference_burst_unit.h"
#include "host/tree/beam.h"
#include "host/tree/walk.h"

namespace raygate {

/// One ray on its way. Depths are distances along its longest axis.
struct RaySearch::Walk {
  const Ray& ray;
  std::uint32_t number;
  Beam beam;
  ShearedRay sheared;
  double pace;                                ///< depth is t times that, exactly
  std::uint32_t ignored = NearestHit::kNone;  ///< a slot
  float enough = -1.0f;                       ///< a hit whose depth is surely less is enough
  std::uint32_t slot = NearestHit::kNone;     ///< of the nearest hit
  float low, high;                            ///< its depth's bounds; without one, the limit's
  float cutoff;                               ///< boxes that are entered beyond do not matter
  RayWork work;

  Walk(const Ray& its_ray, std::uint32_t its_number)
      : ray(its_ray),
        number(its_number),
        beam(its_ray.origin, its_ray.direction),
        sheared(its_ray),
        pace(std::abs(its_ray.direction[sheared.axes[2]])) {}

  /// The nearest hit, or the limit, is at a t within these bounds.
  void end_at(const Interval& t) { end_at(float_below(t.low * pace), float_above(t.high * pace)); }
  void end_at(float lowest, float highest) {
    low = lowest;
    high = highest;
    cutoff = cutoff_beyond(high / pace);
  }
  [[nodiscard]] Interval t() const { return {low / pace, high / pace}; }
};

namespace {

/// What the tree asks (see next_leaf).
struct RayVisitor {
  const RaySearch::Walk& walk;

  RAYGATE_INLINE bool goes_on(float entry, Whole) const { return entry <= walk.cutoff; }
  RAYGATE_INLINE LaneMask meet(const Bvh::Node& node, Whole, FloatLanes& entry) const {
    return meet_children(walk.beam, node, walk.cutoff, entry);
  }
  RAYGATE_INLINE static Whole rays_at(int) { return {}; }
};

}  // namespace

/// Tests a leaf's triangles. False where the ray need not go on.
RAYGATE_INLINE bool RaySearch::test_leaf(Walk& walk, const Bvh::Child& leaf) {
  QuadVerdict verdict;
  test_quad(walk.sheared, bvh_.corners_of(leaf), leaf.count, verdict);
  walk.work.tests += leaf.count;
  LaneMask open = verdict.hit | verdict.level | verdict.doubt;
  if (open == 0) return true;
  HitCounters& counters = counters_.hit;
  counters.hits += static_cast<std::uint64_t>(std::popcount(verdict.hit));
  walk.work.doubts += static_cast<std::uint32_t>(std::popcount(verdict.doubt));
  for (; open != 0; open &= open - 1) {
    const int i = std::countr_zero(open);
    const std::uint32_t slot = leaf.first + static_cast<std::uint32_t>(i);
    const float low = verdict.low[i], high = verdict.high[i];
    if (low > walk.high || slot == walk.ignored) continue;
    if ((verdict.level >> i & 1) != 0) {
      if (!is_ahead(walk.ray, bvh_.corners_of(slot))) continue;
      ++counters.hits;
    }
    if ((verdict.doubt >> i & 1) != 0) {
      if (!settle(walk, slot, false)) continue;
    } else if (high < walk.low) {
      walk.slot = slot;
      walk.end_at(std::max(low, 0.0f), high);
    } else if (!settle(walk, slot, true)) {
      continue;
    }
    if (walk.high < walk.enough) {
      ++counters_.ended_early;
      return false;
    }
  }
  return true;
}

/// Walks the tree, near before far, and tests what is there.
void walk_ray(RaySearch& search, RaySearch::Walk& walk) {
  in_vectors([&](auto) RAYGATE_BODY {
    const RayVisitor visitor{walk};
    WalkStack<Whole> stack({});
    Waiting<Whole> leaf;
    while (next_leaf(search.bvh_, visitor, stack, leaf) && search.test_leaf(walk, leaf.child)) {
    }
  });
}

/// Tests everything.
void visit_all(RaySearch& search, RaySearch::Walk& walk, std::span<const Bvh::Child> leaves) {
  in_vectors([&](auto) RAYGATE_BODY {
    for (const Bvh::Child& leaf : leaves) {
      if (!search.test_leaf(walk, leaf)) return;
    }
  });
}

/// The last word on what float32 leaves open about a triangle that the ray may hit or, if `sure`,
/// does hit. True where that is the nearest hit now.
bool RaySearch::settle(Walk& walk, std::uint32_t slot, bool sure) {
  const Ray& ray = walk.ray;
  NearestHit best;
  if (walk.slot != NearestHit::kNone) {
    best.slot = walk.slot;
    best.t = walk.t();
    counters_.hit.depth_doubts += sure;
  }
  NearestHit hit = {.slot = slot};
  const float limit = search_.limit(walk.number);
  if (sure) hit.t = hit_distance(ray, bvh_.corners_of(slot));
  if (!(sure ? take_if_nearer(bvh_, ray, limit, hit, best, counters_)
             : settle_doubt(bvh_, ray, limit, hit, best, counters_))) {
    return false;
  }
  walk.slot = slot;
  walk.end_at(best.t);
  return true;
}

namespace {

std::vector<Bvh::Child> all_leaves(const Bvh& tree) {
  std::vector<Bvh::Child> leaves;
  for (const Bvh::Node& node : tree.nodes()) {
    for (const Bvh::Child& child : node.child) {
      if (child.count != 0) leaves.push_back(child);
    }
  }
  return leaves;
}

}  // namespace

void RaySearch::trace(std::span<const Ray> rays, const Search& search, std::span<NearestHit> hits) {
  rays_ = rays;
  search_ = search;
  hits_ = hits;
  const std::vector<Bvh::Child> leaves =
      search.culling ? std::vector<Bvh::Child>{} : all_leaves(bvh_);
  HitCounters& counters = counters_.hit;
  const HitCounters before = counters;
  for (std::uint32_t number = 0; number < rays.size(); ++number) {
    const Ray& ray = rays[number];
    if (!is_usable(ray.direction)) continue;
    Walk walk(ray, number);
    if (!(walk.pace >= 1.0 && walk.pace < 2.0)) refuse_unscaled(ray);
    const double limit = search.limit(number);
    walk.end_at({limit, limit});
    if (!search.ignored.empty()) walk.ignored = search.ignored[number];
    if (!search.enough_before.empty()) {
      walk.enough = float_below(search.enough_before[number] * walk.pace);
    }
    if (search.culling) {
      walk_ray(*this, walk);
    } else {
      visit_all(*this, walk, leaves);
    }
    counters.tests += walk.work.tests;
    counters.edge_doubts += walk.work.doubts;
    if (!search.work.empty()) search.work[number] = walk.work;
    if (walk.slot == NearestHit::kNone) continue;
    hits[number].slot = walk.slot;
    hits[number].t = walk.t();
    if (search.enough_before.empty()) add_point(number);
  }
  add_points();
  counters.misses += (counters.tests - before.tests) - (counters.hits - before.hits) -
                     (counters.edge_doubts - before.edge_doubts);
}

/// P, which the search did without: four at a time.
void RaySearch::add_point(std::uint32_t number) {
  pointless_[pointless_count_++] = number;
  if (pointless_count_ == kPlanes) add_points();
}

void RaySearch::add_points() {
  if (pointless_count_ == 0) return;
  std::array<Corners, kPlanes> corners;
  std::array<PlaneView, kPlanes> views;
  for (int i = 0; i < kPlanes; ++i) {
    const std::uint32_t number = pointless_[std::min(i, pointless_count_ - 1)];
    corners[i] = bvh_.corners_of(hits_[number].slot);
    views[i] = {&rays_[number].origin, &corners[i]};
  }
  std::array<PolygonRecord, kPlanes> planes;
  make_planes(views, planes);
  for (int i = 0; i < pointless_count_; ++i) {
    NearestHit& hit = hits_[pointless_[i]];
    const UnitPoint found = plane_point(planes[i], rays_[pointless_[i]].direction);
    hit.point = found.point;
    hit.point_error = found.error;
    ++counters_.hit.plane_tests;
  }
  pointless_count_ = 0;
}

}  // namespace raygate
