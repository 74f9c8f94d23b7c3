// Packet traversal: eight rays traverse the BVH together and stop at each leaf.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

#include "host/base/lanes.h"
#include "host/bvh/bvh.h"
#include "host/bvh/traversal.h"

namespace raygate {

/// Consecutive primitives of a leaf whose boxes the same rays of the packet meet.
struct LeafVisit {
  std::uint32_t first = 0;  ///< primitives [first, first + count)
  std::uint32_t count = 0;
  LaneMask lanes = 0;
};

/// The primitives of a leaf whose boxes any ray meets, grouped by the rays that meet them.
struct LeafVisits {
  std::array<LeafVisit, Bvh::kMaxLeafSize> visits;
  std::size_t count = 0;  ///< number of visits; 0: the traversal has ended

  [[nodiscard]] const LeafVisit* begin() const { return visits.data(); }
  [[nodiscard]] const LeafVisit* end() const { return visits.data() + count; }
};

/// A traversal, roughly front to back, that stops at each leaf and can be resumed. All rays point
/// into one octant. With many packets in flight, a hit-test unit works while packets await results.
///
/// Box tests are conservative: no ray misses a triangle that it hits in exact arithmetic at a
/// distance up to its cutoff (proof in packet_traversal.cpp). A ray also visits other triangles
/// whose boxes it meets, except those in a plane through its origin, which it cannot hit.
class PacketTraversal {
 public:
  /// Rays point into `octant` with scaled directions. Coordinates are at most 2^126 in magnitude.
  PacketTraversal(const Bvh& bvh, int octant);

  /// Sets the ray of an unused lane. Must be called before the first next_leaf().
  void set_ray(int lane, const glm::vec3& origin, const glm::vec3& direction);

  /// Restricts the ray in `lane` to distances up to `t` from now on.
  void set_cutoff(int lane, double t);

  /// Returns the next leaf that any ray meets.
  [[nodiscard]] LeafVisits next_leaf();

 private:
  [[nodiscard]] LaneMask meet(const FloatCorners& corners) const;

  /// A node or leaf to visit, with a lower bound of the distance at which the first ray enters its
  /// box, and the rays that may enter it.
  struct StackEntry {
    Bvh::Child child;
    float entry;
    LaneMask lanes;
  };

  const Bvh* bvh_;
  int octant_;
  FloatLanes origin_[3] = {};
  PacketBounds8 rays_ = {};
  int depth_ = 1;  // number of stack entries; the nearest child of a node is on top
  StackEntry stack_[Bvh::kStackSize];
};

}  // namespace raygate
