// Which polygon each ray of a wavefront hits first, decided exactly.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "host/exact/exact.h"
#include "host/find/unit/hit_tester.h"
#include "host/tree/bvh.h"

namespace raygate {

/// The nearest hit of a ray so far; without one, `slot` alone has a meaning.
struct NearestHit {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t slot = kNone;  ///< of the tree; kNone: nothing hit
  glm::vec3 point{0.0f};       ///< P, relative to the ray's origin, as the engine computed it
  Interval t{};                ///< holds the exact t
};

/// Takes in what a HitTester reports and settles in exact arithmetic what it leaves open: doubts
/// about edges, and the order of hits whose distances overlap (equally far: the lower triangle
/// index is nearer). The outcome depends on the rays and the scene alone, not on the engine nor on
/// the order of the reports.
class NearestHits {
 public:
  struct Counters {
    std::uint64_t exact_inside = 0;  ///< doubts about edges settled: not those surely too far away
    std::uint64_t exact_depth = 0;   ///< pairs of hits, or a hit and a limit, put in order
    double seconds = 0.0;            ///< that both took
  };

  explicit NearestHits(const Bvh& bvh) : bvh_(bvh) {}

  /// Forgets all and begins with rays of numbers 0 to `rays` - 1. With `limits`, one a ray
  /// (positive; +infinity for none), ray i ends at t = limits[i]: only hits with t < limits[i], in
  /// exact arithmetic, are taken. The span is read until the next reset.
  void reset(std::size_t rays, std::span<const float> limits = {}) {
    nearest_.resize(rays);
    for (NearestHit& hit : nearest_) hit.slot = NearestHit::kNone;
    limits_ = limits;
  }

  /// Offers a sure hit of ray `number`. True when it is the nearest now.
  bool offer(std::uint32_t number, const Ray& ray, const SureHit& hit);

  /// Offers a doubt. True when it is a hit, and the nearest now. Asks for its distance first.
  bool offer(std::uint32_t number, const Ray& ray, const Doubt& doubt);

  /// Whether the nearest hit of ray `number`, which there must be, has t < limit (positive), in
  /// exact arithmetic.
  [[nodiscard]] bool is_before(std::size_t number, const Ray& ray, float limit) {
    return is_before(nearest_[number], ray, limit);
  }

  /// Says what the nearest hit of ray `number` is, where it was found otherwise.
  void put(std::uint32_t number, const NearestHit& hit) { nearest_[number] = hit; }

  [[nodiscard]] const NearestHit& operator[](std::size_t number) const { return nearest_[number]; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  bool is_before(const NearestHit& hit, const Ray& ray, float limit);
  bool take_if_nearer(std::uint32_t number, const Ray& ray, const NearestHit& hit);

  const Bvh& bvh_;
  std::vector<NearestHit> nearest_;
  std::span<const float> limits_;
  Counters counters_;
};

}  // namespace raygate
