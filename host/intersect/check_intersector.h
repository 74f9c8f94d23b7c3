// Check intersector: compares two intersectors and stops at the first ray where they differ.
#pragma once

#include <bit>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "host/intersect/intersector.h"

namespace raygate {

/// An exception for results that differ between two implementations. The text is one line with the
/// inputs in hexadecimal, ready to replay, and both results.
class EngineMismatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns floats as hexadecimal words, " 3F800000 BF000000", from which a case can be replayed.
[[nodiscard]] inline std::string hex_words(std::span<const float> words) {
  std::string text;
  for (const float word : words) {
    char buffer[16];
    std::snprintf(buffer, sizeof buffer, " %08X", std::bit_cast<std::uint32_t>(word));
    text += buffer;
  }
  return text;
}

/// Passes all queries to both intersectors and returns the results and counters of the first.
/// Throws EngineMismatch at the first ray whose results differ: in the triangle, in any bit of the
/// hit point or its error, or by disjoint intervals of t. The triangles may differ if both hits
/// are nearer than RayQuery::any_hit_before.
class CheckIntersector : public Intersector {
 public:
  CheckIntersector(const Bvh& bvh, std::unique_ptr<Intersector> intersector,
                   std::unique_ptr<Intersector> reference)
      : Intersector(intersector->traits()),
        bvh_(bvh),
        intersector_(std::move(intersector)),
        reference_(std::move(reference)) {}

  [[nodiscard]] IntersectCounters counters() const override { return intersector_->counters(); }

 private:
  void trace(std::span<const Ray> rays, const RayQuery& query,
             std::span<NearestHit> hits) override {
    intersector_->nearest(rays, query, hits);
    RayQuery same = query;
    same.work = {};
    same.source_ids = {};  // neither `work` nor `source_ids` affects results
    expected_.assign(rays.size(), {});
    reference_->nearest(rays, same, expected_);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (agree(rays[i], query, i, hits[i], expected_[i])) continue;
      const float limit = query.t_max_of(i);
      throw EngineMismatch("the engines differ: ray" + hex(rays[i].origin) + "," +
                           hex(rays[i].direction) + ", limit" + hex_words({&limit, 1}) + ": " +
                           describe(hits[i]) + "; reference: " + describe(expected_[i]));
    }
  }

  [[nodiscard]] bool agree(const Ray& ray, const RayQuery& query, std::size_t number,
                           const NearestHit& a, const NearestHit& b) const {
    if (a.primitive == NearestHit::kNone || b.primitive == NearestHit::kNone) {
      return a.primitive == b.primitive;
    }
    if (!query.any_hit_before.empty() && a.primitive != b.primitive) {
      const float enough = query.any_hit_before[number];
      return is_before(bvh_, ray, a, enough) && is_before(bvh_, ray, b, enough);
    }
    return a.primitive == b.primitive && a.t.low <= b.t.high && b.t.low <= a.t.high &&
           (!query.with_points || (hex(a.point) == hex(b.point) && a.point_error == b.point_error));
  }

  [[nodiscard]] std::string describe(const NearestHit& hit) const {
    if (hit.primitive == NearestHit::kNone) return "no hit";
    return "triangle " + std::to_string(bvh_.triangle_of(hit.primitive)) + " at t " +
           std::to_string(hit.t.low) + ", P" + hex(hit.point);
  }
  static std::string hex(const glm::vec3& v) { return hex_words({&v.x, 3}); }

  const Bvh& bvh_;
  std::unique_ptr<Intersector> intersector_, reference_;
  std::vector<NearestHit> expected_;
};

}  // namespace raygate
