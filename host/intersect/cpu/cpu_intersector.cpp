#include "host/intersect/cpu/cpu_intersector.h"

#include <bit>
#include <cstring>

#include "host/base/measure.h"
#include "host/bvh/traversal.h"
#include "host/intersect/cpu/quad_test.h"

namespace raygate {
void CpuIntersector::trace(std::span<const Ray> rays, const RayQuery& query,
                           std::span<NearestHit> hits) {
  Stopwatch watch;
  HitCounters& counters = counters_.hit;
  const HitCounters before = counters;
  if (query.common_origin && !rays.empty() && query.exact_rays.empty()) {
    trace_packets(bvh_, rays, query, hits, counters_);
  } else {
    trace_single_rays(bvh_, rays, query, hits, counters_);
  }
  counters.misses += (counters.tests - before.tests) - (counters.hits - before.hits) -
                     (counters.edge_doubts - before.edge_doubts);
  counters_.seconds += watch.lap();
}

void PointWriter::write() {
  for (std::size_t first = computed_; first < planes_; first += kQuad) {
    const auto plane = [&](std::size_t i) { return std::min(first + i, planes_ - 1); };
    const auto origin = [&](std::size_t i) { return rays_[firsts_[plane(i)]].origin; };
    const auto corners = [&](std::size_t i) { return bvh_.corners_of(primitives_[plane(i)]); };
    // Initialised in place: a copy would have to wait for the words just stored.
    const PlaneViews views{{origin(0), origin(1), origin(2), origin(3)},
                           {corners(0), corners(1), corners(2), corners(3)}};
    float words[4][kQuad];
    make_planes(views, words);
    FloatQuad rows[kQuad];
    for (int k = 0; k < kQuad; ++k) rows[k] = load<FloatQuad>(words[k]);
    transpose(rows);
    std::memcpy(words_[first], rows, sizeof rows);
  }
  in_vectors([&](auto code) RAYGATE_BODY {
    using Floats = NativeFloats<code()>;
    constexpr std::size_t kHits = kLanesOf<Floats>;
    for (std::size_t first = 0; first < count_; first += kHits) {
      // Each row holds one hit or, after transposition, one word of four hits. A ray's load starts
      // one word before the direction.
      FloatQuad rays[kHits / kQuad][kQuad], planes[kHits / kQuad][kQuad];
      std::uint32_t number[kHits];
      for (std::size_t i = 0; i < kHits; ++i) {
        const std::size_t at = std::min(first + i, count_ - 1);
        number[i] = numbers_[at];
        rays[i / kQuad][i % kQuad] =
            load<FloatQuad>(reinterpret_cast<const float*>(&rays_[number[i]] + 1) - kQuad);
        planes[i / kQuad][i % kQuad] = load<FloatQuad>(words_[plane_of_[at]]);
      }
      for (std::size_t quad = 0; quad < kHits / kQuad; ++quad) {
        transpose(rays[quad]);
        transpose(planes[quad]);
      }
      Floats directions[3], n[3];
      for (int k = 0; k < 3; ++k) {
        directions[k] = joined<Floats>([&](int i) RAYGATE_BODY { return rays[i][k + 1]; });
        n[k] = joined<Floats>([&](int i) RAYGATE_BODY { return planes[i][k]; });
      }
      const Floats d = joined<Floats>([&](int i) RAYGATE_BODY { return planes[i][3]; });
      auto largest = bits_in(n[0]) >> 23 & 0xFF;
      for (int k = 1; k < 3; ++k) largest = maximum(largest, bits_in(n[k]) >> 23 & 0xFF);
      const auto hit = [&](std::size_t i) RAYGATE_BODY { return &hits_[number[i]]; };
      write_lanes(n, d, largest, directions, hit);
    }
  });
  written_ += count_;
  count_ = 0;
  if (!is_common_ || planes_ > kPlanes - kMost) planes_ = 0;
  computed_ = planes_;
}

void all_hits(const Bvh& bvh, const ExactRay& ray, double t_max, std::vector<NearestHit>& hits,
              RayWork& work) {
  hits.clear();
  if (!is_usable(ray.direction)) return;
  const Ray rounded{glm::vec3(ray.origin), glm::vec3(ray.direction)};
  if (!is_scaled(rounded.direction)) throw_unscaled(rounded);
  in_vectors([&](auto) RAYGATE_BODY {
    const ShearedRay sheared(rounded);
    const RoundedParts rounding(!bvh.is_binary32(), ray);
    const RoundedBounds bounds(ray);
    const float cutoff = cutoff_beyond(t_max);
    const BvhView tree(bvh);
    const auto boxes = [&](const Bvh::Node& node) RAYGATE_BODY {
      FloatLanes entry;
      return intersect_children(bounds, node, cutoff, entry);
    };
    const auto take_hits = [&](const Bvh::Child& leaf) RAYGATE_BODY {
      QuadVerdict verdict;
      Bvh::LeafRoom room;
      test_quad<true>(sheared, tree.corners_of(leaf, room), leaf.count, verdict, rounding);
      work.tests += leaf.count;
      work.doubts += static_cast<std::uint32_t>(std::popcount(verdict.doubt));
      for (const int i : SetBits(verdict.hit | verdict.level | verdict.doubt)) {
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
