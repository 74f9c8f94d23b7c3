// Check intersector: compares two intersectors and stops at the first ray where they differ.
#pragma once

#include <bit>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "host/intersect/intersector.h"

namespace raygate {

/// Thrown where two implementations differ. The text is one line with the inputs in hexadecimal,
/// ready to replay, and both results.
class EngineMismatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Passes all queries to both intersectors, returns the results and counters of the first, and
/// throws EngineMismatch at the first ray for which they differ: in the triangle, in any bit of P
/// or its error, or by disjoint intervals of t. For a ray that may end at any hit, both must find
/// one.
class CheckIntersector : public Intersector {
 public:
  CheckIntersector(const Bvh& bvh, std::unique_ptr<Intersector> intersector,
                   std::unique_ptr<Intersector> reference);

  [[nodiscard]] IntersectCounters counters() const override { return intersector_->counters(); }

 private:
  void trace(std::span<const Ray> rays, const RayQuery& query, std::span<NearestHit> hits) override;
  [[nodiscard]] bool agree(const Ray& ray, const RayQuery& query, std::size_t number,
                           const NearestHit& a, const NearestHit& b) const;

  const Bvh& bvh_;
  std::unique_ptr<Intersector> intersector_, reference_;
  std::vector<NearestHit> expected_;
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

}  // namespace raygate
