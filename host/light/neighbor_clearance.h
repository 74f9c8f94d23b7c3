// Neighbor clearance: distance from a triangle to other triangles, computed on first use.
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

/// The triangles that touch a triangle in its interior or intersect it.
class Overlaps {
 public:
  void add(std::uint32_t primitive, const Corners& triangle);
  [[nodiscard]] std::size_t size() const { return primitives_.size(); }

  /// Calls visit(primitive) for triangles whose boxes are within `reach` of the point on each axis,
  /// until a call returns true. Returns whether a call did.
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
  /// Eight boxes; unused ones are empty.
  struct Boxes {
    float low[3][kLanes], high[3][kLanes];
  };

  std::vector<Boxes> boxes_;
  std::vector<std::uint32_t> primitives_;
};

/// The clearance of a triangle ABC for rays that start on it: one cache line.
///
/// Every other triangle is at least c w - margin() away from each point of this one, where w is the
/// smallest of the point's barycentric coordinates; or it is farther than spawn_reach(), one of the
/// overlaps, or in the same plane. Most triangles touch others only at edges and vertices: they
/// have no overlaps, and c is a fraction of their smallest height.
struct alignas(64) NeighborClearance {
  double normal[3] = {};  ///< (B-A) x (C-A) times a power of two: off by less than 1
  /// c, at most 1/8 of the smallest height. 0: unknown. Negative if there are overlaps.
  float length = 0.0f;
  float corner[3] = {};       ///< A
  float gradient[2][3] = {};  ///< gradients of c times the coordinates of B and C, in the plane
};

/// Returns the distance beyond which other triangles are irrelevant to rays that start on a
/// triangle with these vertices: at least 16 float steps of its largest coordinate.
[[nodiscard]] double spawn_reach(const Corners& corners);

/// Returns whether no point of `other` is strictly on the given side (as in orient3d) of the plane
/// of `hit`. Straight lines from that plane to that side then miss `other`, so neighbours along a
/// convex edge are irrelevant, however flat the edge is.
[[nodiscard]] bool lies_beyond(const Corners& other, const Corners& hit, int side);

/// The clearances and overlaps of all triangles of a BVH. Those of instances are not stored.
/// Thread-safe: computed on first use, with the same result in every thread.
class NeighborClearances {
 public:
  /// `bvh` must outlive this object.
  explicit NeighborClearances(const Bvh& bvh);

  [[nodiscard]] const Bvh& bvh() const { return bvh_; }
  [[nodiscard]] float margin() const { return margin_; }

  /// A clearance that is not stored.
  struct Found {
    NeighborClearance clearance;
    Overlaps overlaps;
  };
  /// Computes the clearance of any primitive, including those of instances.
  [[nodiscard]] Found compute(std::uint32_t primitive) const;

  /// Returns the clearance of a primitive that belongs to no instance.
  [[nodiscard]] RAYGATE_INLINE const NeighborClearance& of(std::uint32_t primitive) const {
    const NeighborClearance* const clearance =
        known_[primitive].clearance.load(std::memory_order_acquire);
    return clearance != nullptr ? *clearance : find(primitive);
  }
  /// Prefetch the clearance of a primitive of a later call, in two steps.
  RAYGATE_INLINE void prefetch(std::uint32_t primitive) const {
    if (!bvh_.is_instanced(primitive)) __builtin_prefetch(&known_[primitive]);
  }
  RAYGATE_INLINE void prefetch_again(std::uint32_t primitive) const {
    if (bvh_.is_instanced(primitive)) return;
    __builtin_prefetch(known_[primitive].clearance.load(std::memory_order_relaxed));
  }
  /// Returns the overlaps of a primitive whose clearance is known and negative.
  [[nodiscard]] const Overlaps& overlaps_of(std::uint32_t primitive) const {
    return *known_[primitive].overlaps.load(std::memory_order_relaxed);
  }

 private:
  /// The cached data of a primitive.
  struct Known {
    std::atomic<const NeighborClearance*> clearance{nullptr};  // null: not computed yet
    std::atomic<const Overlaps*> overlaps{nullptr};
  };

  /// Computes and stores the clearance.
  [[nodiscard]] const NeighborClearance& find(std::uint32_t primitive) const;

  const Bvh& bvh_;
  float margin_;
  double slack_;  // error bound of a computed coordinate along a unit vector
  std::unique_ptr<Known[]> known_;
  mutable std::mutex mutex_;
  mutable std::deque<NeighborClearance> clearances_;
  mutable std::deque<Overlaps> overlaps_;
};

}  // namespace raygate
