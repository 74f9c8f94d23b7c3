#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "host/intersect/cpu/ray_traversal.h"
#include "host/intersect/polygon_record.h"

namespace raygate {
namespace {

/// Several rays traverse the BVH interleaved. A leaf's triangles are tested directly from their
/// corners by quad_test. Exact arithmetic resolves doubts of float32 and orders hits, so decisions
/// do not depend on the method.
class SingleRayIntersector {
 public:
  SingleRayIntersector(const Bvh& bvh, std::span<const Ray> rays, const RayQuery& query,
                       std::span<NearestHit> hits, IntersectCounters& counters)
      : bvh_(bvh), counters_(counters), rays_(rays), query_(query), hits_(hits) {}

  void trace() {
    if (query_.culling) {
      walk_all();
    } else {
      visit_all();
    }
    add_points(1);
  }

 private:
  // Number of interleaved rays: enough to hide memory latency, few enough for a 32 KB cache that
  // another thread of the core may share.
  static constexpr int kAtOnce = 24;

  /// Does the second half of a leaf's tests. Returns false if the ray can end.
  RAYGATE_INLINE bool judge(RayTraversal& walk, const Bvh::Child& leaf, const QuadSides& sides,
                            LaneMask open) {
    QuadVerdict verdict;
    judge_sides(walk.sheared, sides, open, verdict);
    open = verdict.hit | verdict.level | verdict.doubt;
    HitCounters& counters = counters_.hit;
    counters.hits += static_cast<std::uint64_t>(std::popcount(verdict.hit));
    walk.work.doubts += static_cast<std::uint32_t>(std::popcount(verdict.doubt));
    for (; open != 0; open &= open - 1) {
      const int i = std::countr_zero(open);
      const std::uint32_t primitive = leaf.first + static_cast<std::uint32_t>(i);
      const float low = verdict.low[i], high = verdict.high[i];
      if (primitive == walk.skip_id || primitive == walk.source_id) continue;
      if (query_.is_enough != nullptr && (verdict.hit >> i & 1) != 0 && high < walk.enough &&
          (*query_.is_enough)(walk.number, primitive)) {
        walk.primitive = primitive;
        walk.end_at(std::max(low, 0.0f), high);
        ++counters_.ended_early;
        return false;
      }
      if (low > walk.high) continue;
      const float cutoff = walk.cutoff;
      if ((verdict.level >> i & 1) != 0) {
        if (!is_ahead(rays_[walk.number], bvh_.corners_of(primitive))) continue;
        ++counters.hits;
      }
      if ((verdict.doubt >> i & 1) != 0) {
        if (!resolve(walk, primitive, false)) continue;
      } else if (high < walk.low) {
        walk.primitive = primitive;
        walk.end_at(std::max(low, 0.0f), high);
      } else if (!resolve(walk, primitive, true)) {
        continue;
      }
      if (query_.is_enough != nullptr) {
        walk.cutoff = cutoff;
      } else if (walk.high < walk.enough) {
        ++counters_.ended_early;
        return false;
      }
    }
    return true;
  }

  /// Resolves a doubt about a triangle that the ray may hit or, if `sure`, does hit. Returns
  /// whether it is the nearest hit now.
  bool resolve(RayTraversal& walk, std::uint32_t primitive, bool sure) {
    const Ray& ray = rays_[walk.number];
    NearestHit best;
    if (walk.primitive != NearestHit::kNone) {
      best.primitive = walk.primitive;
      best.t = walk.t();
      counters_.hit.depth_doubts += sure;
    }
    NearestHit hit = {.primitive = primitive};
    const float limit = query_.t_max_of(walk.number);
    if (sure) hit.t = hit_distance(ray, bvh_.corners_of(primitive));
    if (!(sure ? take_if_nearer(bvh_, ray, limit, hit, best, counters_)
               : resolve_doubt(bvh_, ray, limit, hit, best, counters_))) {
      return false;
    }
    walk.primitive = primitive;
    walk.end_at(best.t);
    return true;
  }

  /// Starts the next rays with these walks. Returns a mask of the walks that have a ray.
  RAYGATE_INLINE LaneMask begin(RayTraversal* const (&walks)[kQuad]) {
    const auto first = static_cast<std::uint32_t>(next_);
    const std::size_t count = std::min<std::size_t>(kQuad, rays_.size() - next_);
    const Ray* rays[kQuad];
    for (std::size_t i = 0; i < kQuad; ++i) rays[i] = &rays_[next_ + std::min(i, count - 1)];
    next_ += count;
    const LaneMask all = (1u << count) - 1, scaled = raygate::begin(rays, walks) & all;
    for (LaneMask left = all & ~scaled; left != 0; left &= left - 1) {
      const Ray& ray = *rays[std::countr_zero(left)];
      if (is_usable(ray.direction)) throw_unscaled(ray);
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      RayTraversal& walk = *walks[i];
      const std::uint32_t number = walk.number = first + i;
      if (!query_.t_max.empty()) {
        walk.end_at(Interval{query_.t_max[number], query_.t_max[number]});
      }
      if (!query_.skip_ids.empty()) walk.skip_id = query_.skip_ids[number];
      if (!query_.source_ids.empty()) walk.source_id = query_.source_ids[number];
      if (!query_.any_hit_before.empty()) {
        walk.enough = float_below(query_.any_hit_before[number] * walk.t_scale());
      }
    }
    return scaled;
  }

  RAYGATE_INLINE void finish(const RayTraversal& walk) {
    HitCounters& counters = counters_.hit;
    counters.tests += walk.work.tests;
    counters.edge_doubts += walk.work.doubts;
    if (!query_.work.empty()) query_.work[walk.number] = walk.work;
    hits_[walk.number].primitive = walk.primitive;
    hits_[walk.number].t = walk.primitive != NearestHit::kNone ? walk.t() : Interval{};
    pointless_[pointless_count_] = walk.number;
    pointless_count_ += walk.primitive != NearestHit::kNone ? 1 : 0;
  }

  /// Tests each ray against all triangles.
  void visit_all() {
    const BvhView tree(bvh_);
    const std::vector<Bvh::Child> leaves = bvh_.leaves();
    const auto walks = std::make_unique<RayTraversal[]>(kQuad);
    while (next_ < rays_.size()) {
      LaneMask open = begin({&walks[0], &walks[1], &walks[2], &walks[3]});
      for (; open != 0; open &= open - 1) {
        RayTraversal& walk = walks[std::countr_zero(open)];
        for (const Bvh::Child& leaf : leaves) {
          QuadSides sides;
          Bvh::LeafRoom room;
          const LaneMask near =
              find_sides(walk.sheared, tree.corners_of(leaf, room), leaf.count, sides);
          walk.work.tests += leaf.count;
          if (near != 0 && !judge(walk, leaf, sides, near)) break;
        }
        finish(walk);
      }
      add_points(kPlanes);
    }
  }

  /// Traverses the BVH with all rays, nearest children first. kAtOnce rays are interleaved to hide
  /// memory latency. Choices that depend on a ray select values instead of branching, since
  /// branches would often be mispredicted.
  void walk_all() {
    const auto walks = std::make_unique<RayTraversal[]>(kAtOnce);
    in_vectors([&](auto code) RAYGATE_BODY {
      // Rays by state: at inner nodes, at leaves, or without work.
      RayTraversal *inside[2 * kAtOnce], *leaves[kAtOnce], *idle[kAtOnce];
      // The children that rays at inner nodes meet.
      MetChildren met[kAtOnce];
      Bvh::Node rooms[kAtOnce];
      // Rays at leaves that do not surely miss all triangles.
      struct {
        RayTraversal* walk;
        LaneMask open;
        QuadSides sides;
      } near[kAtOnce];
      std::size_t inside_count = 0, leaf_count = 0, idle_count = kAtOnce;
      const BvhView tree(bvh_);
      for (std::size_t i = 0; i < kAtOnce; ++i) idle[i] = &walks[i];
      for (;;) {
        while (idle_count >= kQuad && next_ < rays_.size()) {
          idle_count -= kQuad;
          RayTraversal* four[kQuad];
          std::copy_n(idle + idle_count, kQuad, four);
          const LaneMask started = begin(four);
          for (int i = 0; i < kQuad; ++i) {
            const std::size_t on_its_way = started >> i & 1;
            inside[inside_count] = idle[idle_count] = four[i];
            inside_count += on_its_way;
            idle_count += on_its_way ^ 1;
          }
        }
        if (inside_count + leaf_count == 0) return;
        // Two short loops let the processor overlap more rays.
        for (std::size_t i = 0; i < inside_count; ++i) {
          meet_children<code()>(tree, *inside[i], rooms[i], met[i]);
        }
        for (std::size_t i = 0; i < inside_count; ++i) push_children<code()>(*inside[i], met[i]);
        auto* near_end = near;
        for (std::size_t i = 0; i < leaf_count; ++i) {
          RayTraversal& walk = *leaves[i];
          const Bvh::Child leaf = walk.at();
          walk.work.tests += leaf.count;
          Bvh::LeafRoom room;
          near_end->walk = inside[inside_count + i] = &walk;
          near_end->open =
              find_sides(walk.sheared, tree.corners_of(leaf, room), leaf.count, near_end->sides);
          near_end += near_end->open != 0 ? 1 : 0;
        }
        for (const auto* at = near; at != near_end; ++at) {
          if (!judge(*at->walk, at->walk->at(), at->sides, at->open)) at->walk->end();
        }
        const std::size_t count = inside_count + leaf_count, were_idle = idle_count;
        RayTraversal** ends[Bvh::Child::kKinds] = {inside, leaves, idle + idle_count};
        for (std::size_t i = 0; i < count; ++i) {
          RayTraversal& walk = *inside[i];
          go_on(tree, walk);
          *ends[walk.at().kind()]++ = &walk;
        }
        inside_count = static_cast<std::size_t>(ends[Bvh::Child::kInner] - inside);
        leaf_count = static_cast<std::size_t>(ends[Bvh::Child::kLeaf] - leaves);
        idle_count = static_cast<std::size_t>(ends[Bvh::Child::kNone] - idle);
        for (std::size_t i = were_idle; i < idle_count; ++i) finish(*idle[i]);
        add_points(kPlanes);
      }
    });
  }

  /// Computes missing points P, four at a time, until fewer than `enough` are missing.
  void add_points(int enough) {
    if (!query_.any_hit_before.empty()) pointless_count_ = 0;
    while (pointless_count_ >= enough) {
      const int count = std::min(pointless_count_, kPlanes);
      pointless_count_ -= count;
      add_points(std::span<const std::uint32_t>(pointless_).subspan(pointless_count_, count));
    }
  }

  /// Computes P of these rays, at most four, with the bits of plane_point.
  void add_points(std::span<const std::uint32_t> numbers) {
    PlaneViews views;
    NearestHit* hits[kPlanes];
    FloatQuad d[kQuad], n[kQuad];  // n[3]: d of the plane
    static_assert(kPlanes == kQuad);
    for (std::size_t i = 0; i < kPlanes; ++i) {
      const std::uint32_t number = numbers[std::min(i, numbers.size() - 1)];
      const Ray& ray = rays_[number];
      hits[i] = &hits_[number];
      views.origins[i] = ray.origin;
      views.triangles[i] = bvh_.corners_of(hits[i]->primitive);
      d[i] = load<FloatQuad>(reinterpret_cast<const float*>(&ray + 1) - kQuad);
    }
    Planes planes;
    make_planes(views, planes);
    std::memcpy(n, planes.words, sizeof n);
    in_vectors([&](auto) RAYGATE_BODY {
      transpose(d);  // d[0] is unused: the last coordinate of the origins
      IntQuad fields[3], error;
      for (int k = 0; k < 3; ++k) fields[k] = bits_in(n[k]) >> 23 & 0xFF;
      const IntQuad largest = maximum(maximum(fields[0], fields[1]), fields[2]);
      FloatQuad rows[kQuad], point[3];
      plane_points({n[0], n[1], n[2]}, n[3], largest, {d[1], d[2], d[3]}, point, error);
      std::copy_n(point, 3, rows);
      rows[3] = float_of(error);
      transpose(rows);
      static_assert(offsetof(NearestHit, point_error) ==
                    offsetof(NearestHit, point) + 3 * sizeof(float));
      for (std::size_t i = 0; i < numbers.size(); ++i) std::memcpy(&hits[i]->point, &rows[i], 16);
    });
    counters_.hit.plane_tests += numbers.size();
  }

  const Bvh& bvh_;
  IntersectCounters& counters_;
  const std::span<const Ray> rays_;
  const RayQuery query_;
  const std::span<NearestHit> hits_;
  std::size_t next_ = 0;                                    // the next ray to start
  std::array<std::uint32_t, kAtOnce + kPlanes> pointless_;  // hits whose P is not computed yet
  int pointless_count_ = 0;
};

}  // namespace

void trace_single_rays(const Bvh& bvh, std::span<const Ray> rays, const RayQuery& query,
                       std::span<NearestHit> hits, IntersectCounters& counters) {
  SingleRayIntersector(bvh, rays, query, hits, counters).trace();
}

}  // namespace raygate
