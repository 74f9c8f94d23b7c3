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

/// What CheckIntersector throws. Its text is one line with the ray, ready to replay (origin,
/// direction and limit in hex), and what each intersector made of it.
class IntersectorMismatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Asks both intersectors everything, gives the first one's answers and counts, and throws
/// IntersectorMismatch at the first ray of which they say different things: another triangle,
/// another bit of P or of its error, or intervals of t that cannot both hold the truth. Of a ray
/// that may end at any hit before some t, both must say that there is one.
class CheckIntersector : public Intersector {
 public:
  CheckIntersector(const Bvh& bvh, std::unique_ptr<Intersector> intersector,
                   std::unique_ptr<Intersector> reference);

  void intersect(std::span<const Ray> rays, const RayQuery& query,
                 std::span<NearestHit> hits) override;
  [[nodiscard]] std::size_t preferred_batch() const override {
    return intersector_->preferred_batch();
  }
  [[nodiscard]] bool wants_sources() const override { return intersector_->wants_sources(); }
  [[nodiscard]] IntersectCounters counters() const override { return intersector_->counters(); }

 private:
  [[nodiscard]] bool agree(const Ray& ray, const RayQuery& query, std::size_t number,
                           const NearestHit& a, const NearestHit& b) const;

  const Bvh& bvh_;
  std::unique_ptr<Intersector> intersector_, reference_;
  std::vector<NearestHit> expected_;
};

/// " 3F800000 BF000000".
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
