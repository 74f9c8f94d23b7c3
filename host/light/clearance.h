// How far each triangle's surroundings are: found when first asked for, and kept.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "host/exact/exact.h"
#include "host/lanes.h"
#include "host/tree/bvh.h"

namespace raygate {

/// Whether no point of `other` is strictly on the given side (as plane_side) of the plane of `hit`.
/// A straight way from that plane to that side does not meet it then: neighbours along a ridge do
/// not matter, however flat the ridge.
[[nodiscard]] bool lies_beyond(const Corners& other, const Corners& hit, int side);

/// Triangles that come close to one triangle inside its borders: what stands on it, or cuts it.
class Crowd {
 public:
  void add(std::uint32_t slot, const Corners& triangle);
  [[nodiscard]] std::size_t size() const { return slots_.size(); }

  /// Calls visit(slot) for the triangles whose boxes are within `reach` of the point on each axis,
  /// until it says true; whether it did.
  template <class Visit>
  [[nodiscard]] bool any_near(const glm::vec3& point, float reach, const Visit& visit) const {
    for (std::size_t first = 0; first < slots_.size(); first += kLanes) {
      for (LaneMask near = near_of_eight(first, point, reach); near != 0; near &= near - 1) {
        if (visit(slots_[first + static_cast<std::size_t>(std::countr_zero(near))])) return true;
      }
    }
    return false;
  }

 private:
  /// Eight boxes; those that are not there are empty.
  struct Boxes {
    float low[3][kLanes], high[3][kLanes];
  };

  [[nodiscard]] LaneMask near_of_eight(std::size_t first, const glm::vec3& point,
                                       float reach) const;

  std::vector<Boxes> boxes_;
  std::vector<std::uint32_t> slots_;
};

/// For each triangle and each side of it a length c and a crowd, such that every other triangle
/// that has points on that side is either of the crowd or at least c w - margin() away from each
/// point of the triangle, w being the least of that point's three barycentric weights. Most
/// triangles meet others at their edges and corners alone: they have no crowd, and c is some part
/// of their least height.
///
/// Threads may ask at the same time: whoever asks first finds out, and all find the same.
class Clearances {
 public:
  /// The tree must outlive this.
  explicit Clearances(const Bvh& bvh);

  [[nodiscard]] const Bvh& bvh() const { return bvh_; }
  [[nodiscard]] float margin() const { return margin_; }

  struct Clearance {
    /// c on the side where plane_side is 1, and on the other; 0 where nothing is known. Not above
    /// an eighth of the least height.
    float length[2];
    const Crowd* crowd;  ///< or nullptr
  };
  [[nodiscard]] Clearance of(std::uint32_t slot) const {
    const Known& known = known_[slot];
    const Lengths lengths = known.lengths.load(std::memory_order_acquire);
    if (lengths.behind < 0.0f) return find(slot);
    return {{lengths.behind, lengths.before}, known.crowd.load(std::memory_order_relaxed)};
  }

 private:
  struct Lengths {
    float behind, before;
  };
  /// Of a slot.
  struct Known {
    std::atomic<Lengths> lengths{{-1.0f, -1.0f}};  // negative: nobody has asked yet
    std::atomic<const Crowd*> crowd{nullptr};
  };

  /// Finds out, and keeps it.
  [[nodiscard]] Clearance find(std::uint32_t slot) const;
  [[nodiscard]] Lengths look(std::uint32_t slot, Crowd& crowd) const;

  const Bvh& bvh_;
  float margin_;
  double slack_;  // how far a computed coordinate along a unit vector may be off
  std::unique_ptr<Known[]> known_;
  mutable std::mutex mutex_;
  mutable std::deque<Crowd> crowds_;
};

}  // namespace raygate
