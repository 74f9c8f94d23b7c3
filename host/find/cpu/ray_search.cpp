#include "host/find/cpu/ray_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "host/find/cpu/ray_walk.h"
#include "host/find/unit/point_error.h"
#include "host/find/unit/record_batch.h"

namespace raygate {

/// The second half of a leaf's tests. False where the ray need not go on.
RAYGATE_INLINE bool RaySearch::judge(RayWalk& walk, const Bvh::Child& leaf, const QuadSides& sides,
                                     LaneMask open) {
  QuadVerdict verdict;
  judge_sides(walk.sheared, sides, open, verdict);
  open = verdict.hit | verdict.level | verdict.doubt;
  HitCounters& counters = counters_.hit;
  counters.hits += static_cast<std::uint64_t>(std::popcount(verdict.hit));
  walk.work.doubts += static_cast<std::uint32_t>(std::popcount(verdict.doubt));
  for (; open != 0; open &= open - 1) {
    const int i = std::countr_zero(open);
    const std::uint32_t slot = leaf.first + static_cast<std::uint32_t>(i);
    const float low = verdict.low[i], high = verdict.high[i];
    if (low > walk.high || slot == walk.ignored) continue;
    if ((verdict.level >> i & 1) != 0) {
      if (!is_ahead(rays_[walk.number], bvh_.corners_of(slot))) continue;
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

/// The last word on what float32 leaves open about a triangle that the ray may hit or, if `sure`,
/// does hit. True where that is the nearest hit now.
bool RaySearch::settle(RayWalk& walk, std::uint32_t slot, bool sure) {
  const Ray& ray = rays_[walk.number];
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

/// As is_scaled: NaNs and infinities have larger bits.
RAYGATE_INLINE bool is_scaled_inline(const glm::vec3& direction) {
  std::int32_t largest = 0;
  for (int k = 0; k < 3; ++k) {
    largest = std::max(largest, std::bit_cast<std::int32_t>(direction[k]) & 0x7FFFFFFF);
  }
  return largest >= 0x3F800000 && largest < 0x40000000;
}

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

/// Makes ready for the next ray that can hit anything; false where there is none.
RAYGATE_INLINE bool RaySearch::set_out(RayWalk& walk) {
  for (; next_ < rays_.size(); ++next_) {
    const Ray& ray = rays_[next_];
    if (!is_scaled_inline(ray.direction)) {
      if (!is_usable(ray.direction)) continue;
      refuse_unscaled(ray);
    }
    const auto number = static_cast<std::uint32_t>(next_++);
    walk.set_out(ray, number, search_.limit(number));
    if (!search_.ignored.empty()) walk.ignored = search_.ignored[number];
    if (!search_.enough_before.empty()) {
      walk.enough = float_below(search_.enough_before[number] * walk.pace);
    }
    return true;
  }
  return false;
}

/// A ray's way is at its end.
RAYGATE_INLINE void RaySearch::arrive(const RayWalk& walk) {
  HitCounters& counters = counters_.hit;
  counters.tests += walk.work.tests;
  counters.edge_doubts += walk.work.doubts;
  if (!search_.work.empty()) search_.work[walk.number] = walk.work;
  if (walk.slot == NearestHit::kNone) return;
  hits_[walk.number].slot = walk.slot;
  hits_[walk.number].t = walk.t();
  if (search_.enough_before.empty()) add_point(walk.number);
}

/// Each ray tests everything.
void RaySearch::visit_all() {
  const std::vector<Bvh::Child> leaves = all_leaves(bvh_);
  const auto walk = std::make_unique_for_overwrite<RayWalk>();
  while (set_out(*walk)) {
    for (const Bvh::Child& leaf : leaves) {
      QuadSides sides;
      const LaneMask open = find_sides(walk->sheared, bvh_.corners_of(leaf), leaf.count, sides);
      walk->work.tests += leaf.count;
      if (open != 0 && !judge(*walk, leaf, sides, open)) break;
    }
    arrive(*walk);
  }
}

/// All rays walk the tree, near before far, and test what is there: kAtOnce of them take turns, so
/// that none waits for memory, and what one guesses wrongly costs the others little.
void RaySearch::walk_all() {
  constexpr int kAtOnce = 32;
  const auto walks = std::make_unique_for_overwrite<RayWalk[]>(kAtOnce);
  in_vectors([&](auto code) RAYGATE_BODY {
    QuadSides sides[kAtOnce];
    LaneMask open[kAtOnce];
    RayWalk *inside[2 * kAtOnce], *leaves[kAtOnce];  // by where they are
    int inside_count = 0, leaf_count = 0;
    for (; inside_count < kAtOnce && set_out(walks[inside_count]); ++inside_count) {
      inside[inside_count] = &walks[inside_count];
    }
    while (inside_count + leaf_count > 0) {
      for (int i = 0; i < inside_count; ++i) step_inside<code()>(bvh_, *inside[i]);
      for (int i = 0; i < leaf_count; ++i) {
        RayWalk& walk = *leaves[i];
        walk.work.tests += walk.at.count;
        open[i] = find_sides(walk.sheared, bvh_.corners_of(walk.at), walk.at.count, sides[i]);
      }
      for (int i = 0; i < leaf_count; ++i) {
        RayWalk& walk = *leaves[i];
        if (open[i] != 0 && !judge(walk, walk.at, sides[i], open[i])) walk.depth = 0;
        inside[inside_count + i] = &walk;
      }
      const int count = inside_count + leaf_count;
      inside_count = leaf_count = 0;
      for (int i = 0; i < count; ++i) {
        RayWalk& walk = *inside[i];
        if (!go_on(bvh_, walk)) {
          arrive(walk);
          if (!set_out(walk)) continue;
        }
        const bool is_leaf = walk.at.count != 0;
        inside[inside_count] = leaves[leaf_count] = &walk;
        inside_count += is_leaf ? 0 : 1;
        leaf_count += is_leaf ? 1 : 0;
      }
    }
  });
}

void RaySearch::trace(std::span<const Ray> rays, const Search& search, std::span<NearestHit> hits) {
  rays_ = rays;
  search_ = search;
  hits_ = hits;
  next_ = 0;
  HitCounters& counters = counters_.hit;
  const HitCounters before = counters;
  if (search.culling) {
    walk_all();
  } else {
    visit_all();
  }
  add_points();
  counters.misses += (counters.tests - before.tests) - (counters.hits - before.hits) -
                     (counters.edge_doubts - before.edge_doubts);
}

/// P, which the search did without: four at a time.
RAYGATE_INLINE void RaySearch::add_point(std::uint32_t number) {
  pointless_[pointless_count_++] = number;
  if (pointless_count_ == kPlanes) add_points();
}

/// P has the bits of plane_point.
void RaySearch::add_points() {
  if (pointless_count_ == 0) return;
  std::array<Corners, kPlanes> corners;
  std::array<PlaneView, kPlanes> views;
  std::array<NearestHit*, kPlanes> hits;
  FloatQuad origin, d[kQuad], n[kQuad];  // n[3]: d of the plane
  static_assert(kPlanes == kQuad);
  for (int i = 0; i < kPlanes; ++i) {
    const std::uint32_t number = pointless_[std::min(i, pointless_count_ - 1)];
    hits[i] = &hits_[number];
    corners[i] = bvh_.corners_of(hits[i]->slot);
    views[i] = {&rays_[number].origin, &corners[i]};
    load_ray(rays_[number], origin, d[i]);
  }
  std::array<PolygonRecord, kPlanes> planes;
  make_planes(views, planes);
  for (int i = 0; i < kPlanes; ++i) load_quad(&planes[i].normal.x, n[i]);
  in_vectors([&](auto) RAYGATE_BODY {
    transpose(d);
    transpose(n);
    const FloatQuad v = 0.0f + ((n[0] * d[0] + n[1] * d[1]) + n[2] * d[2]);
    IntQuad fields[3], grazing, error;
    for (int k = 0; k < 3; ++k) fields[k] = reinterpret_cast<IntQuad>(n[k]) >> 23 & 0xFF;
    IntQuad largest = fields[0] > fields[1] ? fields[0] : fields[1];
    largest = largest > fields[2] ? largest : fields[2];
    grazing_of(largest, reinterpret_cast<IntQuad>(v), grazing);
    point_error_of(reinterpret_cast<IntQuad>(n[3]), reinterpret_cast<IntQuad>(v), grazing, error);
    FloatQuad rows[kQuad];
    for (int k = 0; k < 3; ++k) {
      const FloatQuad p = n[3] * d[k] / v;
      const IntQuad nan = IntQuad{} + 0x7FC00000;
      rows[k] = p == p ? p : reinterpret_cast<FloatQuad>(nan);
    }
    rows[3] = reinterpret_cast<FloatQuad>(error);
    transpose(rows);
    static_assert(offsetof(NearestHit, point_error) ==
                  offsetof(NearestHit, point) + 3 * sizeof(float));
    for (int i = 0; i < pointless_count_; ++i) std::memcpy(&hits[i]->point, &rows[i], 16);
  });
  counters_.hit.plane_tests += static_cast<std::uint64_t>(pointless_count_);
  pointless_count_ = 0;
}

}  // namespace raygate
