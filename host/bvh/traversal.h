// BVH traversal: the leaves whose boxes a query meets, and slab tests of rays with one origin.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

#include "host/base/lanes.h"
#include "host/bvh/bvh.h"

namespace raygate {

/// Calls visit(leaf) for leaves, in any order, until a call returns true. Returns whether a call
/// did. boxes(node) returns a mask of the node's children to visit.
template <class Boxes, class Visit>
RAYGATE_INLINE bool any_leaf(const Bvh& bvh, const Boxes& boxes, const Visit& visit) {
  const BvhView tree(bvh);
  std::uint32_t waiting[Bvh::kStackSize];
  waiting[0] = 0;
  for (int depth = 1; depth > 0;) {
    Bvh::Node room;
    const Bvh::Node& node = tree.node(waiting[--depth], room);
    const LaneMask met = boxes(node);
    for (const int i : SetBits(met)) {
      tree.prefetch(node.child[i]);
      if (node.child[i].count == 0) waiting[depth++] = node.child[i].first;
    }
    for (const int i : SetBits(met)) {
      if (node.child[i].count != 0 && visit(node.child[i])) return true;
    }
  }
  return false;
}

// Why no true hit is culled
//
// packet_traversal.cpp has the proof for one ray with origin O and direction I. The ray's entry
// into a box is the maximum of 0 and float32((near - O) * inverse_near) of each axis; its exit is
// the minimum of its cutoff and float32((far - O) * inverse_far) of each axis.
//
// Bounds of several rays use inverse_near of a component no smaller in magnitude than any ray's,
// and inverse_far of a component no larger. Inverses do not grow with the magnitude, so
// |inverse_near| is at most, and |inverse_far| at least, the value of each ray.
// If near - O has the sign of I, the bounds enter no later than any ray; otherwise all enter at 0.
// If far - O has the sign of I, the bounds leave no earlier than any ray; otherwise no ray hits
// anything in the box. The cutoff of the bounds is at least each ray's cutoff.

/// Direction components below this in magnitude count as 0. Exits are multiplied by kExitGrowth.
inline constexpr float kSmallestComponent = 0x1p-100f;
inline constexpr float kExitGrowth = 1.0f + 0x1p-21f;

/// Returns the octant that a direction points into: bit k is set if component k is negative.
[[nodiscard]] inline int octant_of(const glm::vec3& direction) {
  return (direction.x < 0.0f ? 1 : 0) | (direction.y < 0.0f ? 2 : 0) | (direction.z < 0.0f ? 4 : 0);
}

/// Returns the distance beyond which boxes can be skipped for a ray with maximum distance `t`:
/// t (1 + 2^-21), rounded up. The result is at most the largest float, so that boxes with an entry
/// of +infinity are skipped. For negative t the result is -1: every box is skipped.
[[nodiscard]] inline float cutoff_beyond(double t) {
  constexpr std::int32_t kFarthest = 0x7F7FFFFF;  // the largest float
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

/// Sets the origins for computing entries and exits, so that rounding a ray to binary32 culls no
/// box. Rounding the direction changes entries and exits by a relative 2.1 * 2^-24. For entries,
/// the growth in cutoff_beyond covers this error; for exits, `inverse_far` grows once more.
RAYGATE_INLINE void spread(const ExactRay& ray, float (&entry)[3], float (&exit)[3],
                           float (&inverse_far)[3]) {
  const float growth = is_binary32(ray.direction) ? 1.0f : kExitGrowth;
  for (int k = 0; k < 3; ++k) {
    const bool is_negative = ray.direction[k] < 0.0;
    entry[k] = is_negative ? float_below(ray.origin[k]) : float_above(ray.origin[k]);
    exit[k] = is_negative ? float_above(ray.origin[k]) : float_below(ray.origin[k]);
    inverse_far[k] *= growth;
  }
}

/// Bounds of a binary64 ray, computed from the ray rounded to binary32.
struct RoundedBounds : PacketBounds {
  float exit[3];

  explicit RoundedBounds(const ExactRay& ray)
      : PacketBounds(glm::vec3(ray.origin), glm::vec3(ray.direction)) {
    spread(ray, origin, exit, inverse_far);
  }
};

/// Return the origin from which exits are computed.
inline const float (&exit_origin(const PacketBounds& bounds))[3] { return bounds.origin; }
inline const float (&exit_origin(const RoundedBounds& bounds))[3] { return bounds.exit; }

/// Returns a mask of the node's children whose boxes the bounds meet before `cutoff` (see
/// cutoff_beyond); sets entry[i] to the distance at which they enter child i.
template <Vectors kCode = Vectors::kBaseline, class Bounds>
RAYGATE_INLINE LaneMask intersect_children(const Bounds& bounds, const Bvh::Node& node,
                                           float cutoff, FloatLanes& entry) {
  FloatLanes enter = {}, leave = FloatLanes{} + cutoff;
  for (int k = 0; k < 3; ++k) {
    const int negative = bounds.octant >> k & 1;
    const FloatLanes near = load<FloatLanes>(node.bounds[negative][k]),
                     far = load<FloatLanes>(node.bounds[negative ^ 1][k]);
    const FloatLanes t_near = (near - bounds.origin[k]) * bounds.inverse_near[k];
    const FloatLanes t_far = (far - exit_origin(bounds)[k]) * bounds.inverse_far[k];
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

/// Returns the bounds of packet `which`, with origin and octant of `like`, for intersect_children.
RAYGATE_INLINE PacketBounds bounds_of(const PacketBounds8& bounds8, int which,
                                      const PacketBounds& like) {
  PacketBounds bounds = like;
  for (int k = 0; k < 3; ++k) {
    bounds.inverse_near[k] = bounds8.inverse_near[k][which];
    bounds.inverse_far[k] = bounds8.inverse_far[k][which];
  }
  return bounds;
}

/// Returns a mask of the packets that meet a box before their cutoffs; sets their entry distances.
/// `near` and `far` are the planes of the box that rays of their octant meet first and last.
template <Vectors kCode = Vectors::kBaseline, class Origin>
RAYGATE_INLINE LaneMask intersect_box(const PacketBounds8& bounds8, const Origin (&origin)[3],
                                      const float (&near)[3], const float (&far)[3],
                                      FloatLanes& enter) {
  enter = FloatLanes{};
  FloatLanes leave = bounds8.cutoff;
  for (int k = 0; k < 3; ++k) {
    const FloatLanes t_near = (near[k] - origin[k]) * bounds8.inverse_near[k];
    const FloatLanes t_far = (far[k] - origin[k]) * bounds8.inverse_far[k];
    enter = t_near > enter ? t_near : enter;
    leave = t_far < leave ? t_far : leave;
  }
  return sign_mask<kCode>(enter <= leave);
}

/// Calls intersect_box for the box of a node's child.
template <Vectors kCode = Vectors::kBaseline, class Origin>
RAYGATE_INLINE LaneMask intersect_child(const PacketBounds8& bounds8, const Origin (&origin)[3],
                                        int octant, const Bvh::Node& node, int child,
                                        FloatLanes& enter) {
  float near[3], far[3];
  for (int k = 0; k < 3; ++k) {
    const int negative = octant >> k & 1;
    near[k] = node.bounds[negative][k][child];
    far[k] = node.bounds[negative ^ 1][k][child];
  }
  return intersect_box<kCode>(bounds8, origin, near, far, enter);
}

}  // namespace raygate
