// How far each triangle's surroundings are: found when first asked for, and kept.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "host/exact/exact.h"
#include "host/tree/bvh.h"

namespace raygate {

/// Whether no point of `other` is strictly on the given side (as plane_side) of the plane of `hit`.
/// A straight way from that plane to that side does not meet it then: neighbours along a ridge do
/// not matter, however flat the ridge.
[[nodiscard]] bool lies_beyond(const Corners& other, const Corners& hit, int side);

/// For each triangle and each side of it a length c, such that every other triangle that has points
/// on that side is farther than c w - margin() from a point of the triangle, w being the least of
/// that point's three barycentric weights. Most triangles meet others at their edges and corners
/// alone, and then c is some part of their least height.
///
/// Threads may ask at the same time: whoever asks first finds out, and all find the same.
class Clearances {
 public:
  /// The tree must outlive this.
  explicit Clearances(const Bvh& bvh);

  [[nodiscard]] const Bvh& bvh() const { return bvh_; }
  [[nodiscard]] float margin() const { return margin_; }

  /// c on the two sides of a triangle; 0 where nothing is known. Not above the least height.
  struct Sides {
    float behind;  ///< the side of which plane_side is 1
    float before;  ///< that of -1
  };
  [[nodiscard]] Sides of(std::uint32_t slot) const {
    const Sides sides = known_[slot].load(std::memory_order_relaxed);
    return sides.behind >= 0.0f ? sides : look(slot);
  }

 private:
  [[nodiscard]] Sides look(std::uint32_t slot) const;
  [[nodiscard]] Sides found(std::uint32_t slot) const;

  const Bvh& bvh_;
  float margin_;
  double slack_;  // how far a computed coordinate along a unit vector may be off
  std::unique_ptr<std::atomic<Sides>[]> known_;  // of the slots; negative: not asked for yet
};

}  // namespace raygate
