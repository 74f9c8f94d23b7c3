// Packet traversal: eight rays traverse the BVH together and stop at each leaf; and slab tests of
// many rays with one origin as if they were one ray.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

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
  std::size_t count = 0;  ///< 0: the traversal has ended

  [[nodiscard]] const LeafVisit* begin() const { return visits.data(); }
  [[nodiscard]] const LeafVisit* end() const { return visits.data() + count; }
};

/// A traversal that stops at every leaf and can be resumed, front to back along the octant of its
/// rays. Many packets in flight keep a hit-test unit busy while each waits for its own results.
///
/// Box tests are conservative: no ray misses a triangle that it hits in exact arithmetic at a
/// distance up to its cutoff (proof in packet_traversal.cpp). A ray also visits other triangles
/// whose boxes it meets, except those in a plane through its origin, which no ray hits.
class PacketTraversal {
 public:
  /// All rays point into one octant. Directions are scaled (scaled_direction: the largest component
  /// in [1, 2)); coordinates have a magnitude of at most 2^126.
  PacketTraversal(const Bvh& bvh, int octant);

  /// Sets the ray of an unused lane. Must be called before the first next_leaf().
  void set_ray(int lane, const glm::vec3& origin, const glm::vec3& direction);

  /// Restricts the ray in `lane` to distances up to `t` from now on.
  void set_cutoff(int lane, double t);

  /// Returns the next leaf that any ray meets.
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

// Why no true hit is culled
//
// packet_traversal.cpp proves it for one ray, whose entry into a box is the maximum of 0 and
// float32((near - O) * inverse_near) of each axis, and whose exit is the minimum of its cutoff and
// float32((far - O) * inverse_far). Both inverses have the sign of the direction's component, and
// never grow with its magnitude, as rounding is monotonic. So bounds with inverse_near for a
// magnitude no smaller than that of any ray, and inverse_far for one no larger, enter
//   * no later than any ray, if near - O has the sign of I;
//   * at 0 or before, as the rays do, otherwise;
// and leave no earlier than any ray, if far - O has the sign of I (otherwise no ray hits anything
// in the box). Their cutoff is at least that of each ray.

/// Direction components with a smaller magnitude count as 0. Exit distances are multiplied by
/// kExitGrowth. Both are the same for single rays and packets.
inline constexpr float kSmallestComponent = 0x1p-100f;
inline constexpr float kExitGrowth = 1.0f + 0x1p-21f;

/// Returns the octant that a direction points into: bit k is set if component k is negative.
[[nodiscard]] inline int octant_of(const glm::vec3& direction) {
  return (direction.x < 0.0f ? 1 : 0) | (direction.y < 0.0f ? 2 : 0) | (direction.z < 0.0f ? 4 : 0);
}

/// Returns the distance beyond which boxes can be skipped for a ray with maximum distance `t`: t (1
/// + 8 u) rounded up, and finite, so that an entry of +infinity means that a box is not entered.
/// For negative t returns -1, so that every box is skipped.
[[nodiscard]] inline float cutoff_beyond(double t) {
  constexpr std::int32_t kFarthest = 0x7F7FFFFF;  // the largest float; larger than any t or entry
  if (t < 0.0) return -1.0f;
  const auto nearest = std::bit_cast<std::int32_t>(static_cast<float>(t * kExitGrowth));
  return std::bit_cast<float>(std::min(nearest + 1, kFarthest));
}

/// Bounds of rays with one origin and octant.
struct PacketBounds {
  float origin[3];
  float inverse_near[3], inverse_far[3];
  int octant;  ///< see octant_of

  PacketBounds() = default;
  /// Bounds of one ray. Its direction must be scaled.
  PacketBounds(const glm::vec3& from, const glm::vec3& direction) : octant(octant_of(direction)) {
    for (int k = 0; k < 3; ++k) {
      const bool small = std::abs(direction[k]) < kSmallestComponent;
      const float sign = (octant >> k & 1) != 0 ? -1.0f : 1.0f;
      constexpr float kInfinity = std::numeric_limits<float>::infinity();
      origin[k] = from[k];
      inverse_near[k] = small ? sign / kSmallestComponent : 1.0f / direction[k];
      inverse_far[k] = small ? sign * kInfinity : kExitGrowth * (1.0f / direction[k]);
    }
  }
};

/// Returns a mask of the node's children whose boxes the bounds meet before `cutoff` (see
/// cutoff_beyond); sets entry[i] to the distance at which they enter child i.
template <Vectors kCode = Vectors::kBaseline>
RAYGATE_INLINE LaneMask intersect_children(const PacketBounds& bounds, const Bvh::Node& node,
                                           float cutoff, FloatLanes& entry) {
  FloatLanes enter = {}, leave = FloatLanes{} + cutoff;
  for (int k = 0; k < 3; ++k) {
    const int negative = bounds.octant >> k & 1;
    const FloatLanes near = load<FloatLanes>(node.bounds[negative][k]),
                     far = load<FloatLanes>(node.bounds[negative ^ 1][k]);
    const FloatLanes t_near = (near - bounds.origin[k]) * bounds.inverse_near[k];
    const FloatLanes t_far = (far - bounds.origin[k]) * bounds.inverse_far[k];
    enter = t_near > enter ? t_near : enter;
    leave = t_far < leave ? t_far : leave;
  }
  entry = enter;
  return sign_mask<kCode>(enter <= leave);
}

/// Bounds of eight packets with one origin and octant. An absent packet has a negative cutoff.
struct PacketBounds8 {
  FloatLanes inverse_near[3], inverse_far[3];
  FloatLanes cutoff;

  /// Sets one axis from bounds of the magnitudes of the rays' direction components.
  RAYGATE_INLINE void set(int axis, int octant, const FloatLanes& smallest,
                          const FloatLanes& largest) {
    const float sign = (octant >> axis & 1) != 0 ? -1.0f : 1.0f;
    const FloatLanes least = FloatLanes{} + kSmallestComponent;
    inverse_near[axis] = sign / (largest > least ? largest : least);
    inverse_far[axis] = smallest < least
                            ? FloatLanes{} + sign * std::numeric_limits<float>::infinity()
                            : kExitGrowth * (sign / smallest);
  }
};

/// Returns one of the eight packets as bounds for intersect_children.
RAYGATE_INLINE PacketBounds bounds_of(const PacketBounds8& bounds8, int which,
                                      const PacketBounds& like) {
  PacketBounds bounds = like;
  for (int k = 0; k < 3; ++k) {
    bounds.inverse_near[k] = bounds8.inverse_near[k][which];
    bounds.inverse_far[k] = bounds8.inverse_far[k][which];
  }
  return bounds;
}

/// Returns a mask of the packets that meet the box of a node's child.
template <Vectors kCode = Vectors::kBaseline>
RAYGATE_INLINE LaneMask intersect_packets(const PacketBounds8& bounds8, const glm::vec3& origin,
                                          int octant, const Bvh::Node& node, int child) {
  FloatLanes enter = {}, leave = bounds8.cutoff;
  for (int k = 0; k < 3; ++k) {
    const int negative = octant >> k & 1;
    const float near = node.bounds[negative][k][child] - origin[k];
    const float far = node.bounds[negative ^ 1][k][child] - origin[k];
    const FloatLanes t_near = near * bounds8.inverse_near[k];
    const FloatLanes t_far = far * bounds8.inverse_far[k];
    enter = t_near > enter ? t_near : enter;
    leave = t_far < leave ? t_far : leave;
  }
  return sign_mask<kCode>(enter <= leave);
}

}  // namespace raygate
