// Packet traversal: takes eight rays through the tree and stops at each leaf.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

#include "host/base/lanes.h"
#include "host/bvh/bvh.h"
#include "host/bvh/packet_bounds.h"
#include "host/bvh/traversal.h"

namespace raygate {

/// Some primitives of a leaf that a packet came to, and which of its rays intersect_boxes the boxes
/// of each.
struct LeafVisit {
  std::uint32_t first = 0;  ///< the primitives first .. first + count
  std::uint32_t count = 0;
  LaneMask lanes = 0;
};

/// A leaf's primitives that any ray meets, as runs that the same rays intersect_boxes.
struct LeafVisits {
  std::array<LeafVisit, Bvh::kMaxLeafSize> visits;
  std::size_t count = 0;  ///< 0: all rays have seen everything

  [[nodiscard]] const LeafVisit* begin() const { return visits.data(); }
  [[nodiscard]] const LeafVisit* end() const { return visits.data() + count; }
};

/// A traversal that can be left at every leaf and resumed, front to back along the octant of its
/// rays. Many packets in flight keep a hit-test unit busy while each waits for its own results.
///
/// No ray misses a triangle that it hits in exact arithmetic (at t no farther than its cutoff):
/// packet_traversal.cpp has the proof. Of others it comes to those whose own boxes it meets; those
/// in the plane of its origin, which no ray hits, may be missed.
class PacketTraversal {
 public:
  /// All rays point into one octant. Directions as scaled_direction gives them (the largest
  /// component in [1, 2)); coordinates of magnitude at most 2^126.
  PacketTraversal(const Bvh& bvh, int octant);

  /// Adds a ray to a lane that has none, before the first call of next_leaf.
  void set_ray(int lane, const glm::vec3& origin, const glm::vec3& direction);

  /// From now on the ray in `lane` looks for nothing beyond `t`.
  void set_cutoff(int lane, double t);

  /// The next leaf for any ray.
  [[nodiscard]] LeafVisits next_leaf();

 private:
  friend struct PacketVisitor;
  friend void advance(PacketTraversal& packet, LeafVisits& leaf);

  FloatLanes origin_[3] = {};
  FloatLanes inverse_near_[3] = {}, inverse_far_[3] = {};
  FloatLanes cutoff_;
  const Bvh* bvh_;
  int octant_;
  TraversalStack<LaneMask> stack_{0xFF};
};

}  // namespace raygate
