// Neighbor clearance: how near other triangles come to a triangle, computed on first use and kept.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "host/base/lanes.h"
#include "host/base/vectors.h"
#include "host/bvh/bvh.h"
#include "host/exact/exact.h"

namespace raygate {

/// Overlaps: the triangles that stand on a triangle or cut it.
class Overlaps {
 public:
  void add(std::uint32_t primitive, const Corners& triangle);
  [[nodiscard]] std::size_t size() const { return primitives_.size(); }

  /// Calls visit(primitive) for the triangles whose boxes are within `reach` of the point on each
  /// axis, until it says true; whether it did.
  template <Vectors kCode = Vectors::kBaseline, class Visit>
  [[nodiscard]] RAYGATE_INLINE bool any_near(const glm::vec3& point, float reach,
                                             const Visit& visit) const {
    const glm::vec3 from = point - reach, to = point + reach;
    const std::uint32_t* primitives = primitives_.data();
    for (const Boxes& boxes : boxes_) {
      IntLanes touches = IntLanes{} - 1;
      for (int k = 0; k < 3; ++k) {
        const FloatLanes low = load<FloatLanes>(boxes.low[k]),
                         high = load<FloatLanes>(boxes.high[k]);
        touches &= (low <= to[k]) & (high >= from[k]);
      }
      for (LaneMask near = sign_mask<kCode>(touches); near != 0; near &= near - 1) {
        if (visit(primitives[std::countr_zero(near)])) return true;
      }
      primitives += kLanes;
    }
    return false;
  }

 private:
  /// Eight boxes; those that are not there are empty.
  struct Boxes {
    float low[3][kLanes], high[3][kLanes];
  };

  std::vector<Boxes> boxes_;
  std::vector<std::uint32_t> primitives_;
};

/// The clearance of a triangle ABC, for rays that begin on it: one cache line.
///
/// All other triangles are at least c w - margin() away from each point of this one, w being the
/// least of that point's three barycentric weights, or farther than spawn_reach(), or one of its
/// overlaps, or in its plane. Most triangles meet others at their edges and corners alone: they
/// have no overlaps, and c is some part of their least height.
struct alignas(64) NeighborClearance {
  double normal[3] = {};  ///< (B-A) x (C-A) times a power of two: off by less than 1
  /// c, at most an eighth of the least height; 0: nothing is known. Negative where there are
  /// overlaps.
  float length = 0.0f;
  float corner[3] = {};       ///< A
  float gradient[2][3] = {};  ///< of c times the weights of B and of C, in the triangle's plane
};

/// How far away from a triangle with these vertices things may matter to rays that begin on it: 16
/// float steps of its largest coordinate, or more.
[[nodiscard]] double spawn_reach(const Corners& corners);

/// Whether no point of `other` is strictly on the given side (as orient3d) of the plane of `hit`.
/// A straight way from that plane to that side does not meet it then: neighbours along a ridge do
/// not matter, however flat the ridge.
[[nodiscard]] bool lies_beyond(const Corners& other, const Corners& hit, int side);

/// The clearances and the overlaps of all triangles of a tree. Those of instances are not kept.
///
/// Threads may ask at the same time: whoever asks first finds out, and all find the same.
class NeighborClearances {
 public:
  /// The tree must outlive this.
  explicit NeighborClearances(const Bvh& bvh);

  [[nodiscard]] const Bvh& bvh() const { return bvh_; }
  [[nodiscard]] float margin() const { return margin_; }

  /// A clearance that is not kept.
  struct Found {
    NeighborClearance clearance;
    Overlaps overlaps;
  };
  /// Finds it out: of any triangle, an instance's too, of which there may be too many to keep.
  [[nodiscard]] Found look(std::uint32_t primitive) const;

  /// Of a primitive that is no instance's.
  [[nodiscard]] RAYGATE_INLINE const NeighborClearance& of(std::uint32_t primitive) const {
    const NeighborClearance* const clearance =
        known_[primitive].clearance.load(std::memory_order_acquire);
    return clearance != nullptr ? *clearance : find(primitive);
  }
  /// Says that a triangle's will soon be asked for; later, once more.
  RAYGATE_INLINE void prefetch(std::uint32_t primitive) const {
    if (!bvh_.is_instanced(primitive)) __builtin_prefetch(&known_[primitive]);
  }
  RAYGATE_INLINE void prefetch_again(std::uint32_t primitive) const {
    if (bvh_.is_instanced(primitive)) return;
    __builtin_prefetch(known_[primitive].clearance.load(std::memory_order_relaxed));
  }
  /// Of a triangle whose clearance has been asked for, and says that there is one.
  [[nodiscard]] const Overlaps& overlaps_of(std::uint32_t primitive) const {
    return *known_[primitive].overlaps.load(std::memory_order_relaxed);
  }

 private:
  /// Of a primitive.
  struct Known {
    std::atomic<const NeighborClearance*> clearance{nullptr};  // nobody has asked yet
    std::atomic<const Overlaps*> overlaps{nullptr};
  };

  /// Finds out, and keeps it.
  [[nodiscard]] const NeighborClearance& find(std::uint32_t primitive) const;

  const Bvh& bvh_;
  float margin_;
  double slack_;  // how far a computed coordinate along a unit vector may be off
  std::unique_ptr<Known[]> known_;
  mutable std::mutex mutex_;
  mutable std::deque<NeighborClearance> clearances_;
  mutable std::deque<Overlaps> overlaps_;
};

}  // namespace raygate
