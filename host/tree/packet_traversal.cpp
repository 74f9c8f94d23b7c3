#include "host/tree/packet_traversal.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

// Why no true hit is culled
//
// Let the ray meet a triangle at t* > 0, t* at most the exact cutoff, I its direction, and
// u = 2^-24. On each axis t* I = x - O for a coordinate x inside the triangle's box, which the tree
// stores at least one float, so at least 2^-149, wider: low' + 2^-149 <= x <= high' - 2^-149. By
// symmetry let I > 0; near = low', far = high'.
//
// Entry: float32((near - O) * inverse_near). A difference of floats is off by a factor 1 + u and
// never
//   underflows; with |coordinates| <= 2^126 it does not overflow.
//   * I >= 2^-100: inverse_near = float32(1/I), a normal number off by 1 + u. The product is off
//     by 1 + u or by 2^-150 if it underflows; (near - O) <= t* I - 2^-149 and 1/I > 1/2, so the
//     2^-150 is paid for by the widening, and the entry is at most t* (1 + 3.1 u), or negative.
//     If the product overflows, t* > 2^127, while the axis of the largest I, in [1, 2), says
//     t* <= 2^127: it does not happen.
//   * I < 2^-100, or 0: inverse_near = 2^100 <= 1/I, so a positive entry comes out no later than
//     above, and a negative or zero one never later than 0. With I = 0, near - O < 0.
// Exit: float32((far - O) * inverse_far).
//   * I >= 2^-100: inverse_far = float32((1 + 8 u) float32(1/I)) (Ize, "Robust BVH ray traversal",
//     2013, grows the exit likewise). Four roundings: the exit is at least
//     t* (1 + 8 u) (1 - u)^4 > t* (1 + 3.9 u); underflow is paid for as above.
//   * I < 2^-100: inverse_far = +infinity, and far - O > 0: the exit is +infinity.
// Cutoff: stored as t (1 + 8 u), rounded up; finite, so that an entry of +infinity stands for a ray
//   that does not enter.
// So every axis' entry <= t* (1 + 3.1 u) < every axis' exit and the cutoff, and the box is visited.
//
// A product may be 0 * infinity = NaN (far = O, I = 0: a ray within a face that the widening
// has moved away from its triangle). Each comparison is written so that a NaN loses.

namespace raygate {
namespace {

constexpr float kFarthest = std::numeric_limits<float>::max();  // no t is, nor any entry

}  // namespace

PacketTraversal::PacketTraversal(const Bvh& bvh, int octant)
    : cutoff_(FloatLanes{} - 1.0f),  // below any entry: no ray
      bvh_(&bvh),
      octant_(octant),
      stack_({0, 0, 0}) {}

void PacketTraversal::set_ray(int lane, const glm::vec3& origin, const glm::vec3& direction) {
  assert(octant_of(direction) == octant_);
  cutoff_[lane] = kFarthest;
  const Beam beam(origin, direction);
  for (int k = 0; k < 3; ++k) {
    origin_[k][lane] = origin[k];
    inverse_near_[k][lane] = beam.inverse_near[k];
    inverse_far_[k][lane] = beam.inverse_far[k];
  }
}

void PacketTraversal::set_cutoff(int lane, double t) { cutoff_[lane] = cutoff_beyond(t); }

/// A packet on its way, at hand in registers.
struct PacketTraversal::Visitor {
  const PacketTraversal& packet;
  const Bvh& bvh;
  const Bvh::Node* node;            // of the last meeting
  std::uint8_t lanes[Bvh::kWidth];  // the rays that meet its children

  /// The rays that meet a child's box, and where they enter it.
  RAYGATE_INLINE LaneMask lanes_at(const Bvh::Node& of, int child, FloatLanes& enter) const {
    FloatLanes leave = packet.cutoff_;
    enter = FloatLanes{};
    for (int k = 0; k < 3; ++k) {
      const int negative = packet.octant_ >> k & 1;
      const float near = of.bounds[negative][k][child], far = of.bounds[negative ^ 1][k][child];
      const FloatLanes t_near = (near - packet.origin_[k]) * packet.inverse_near_[k];
      const FloatLanes t_far = (far - packet.origin_[k]) * packet.inverse_far_[k];
      enter = t_near > enter ? t_near : enter;
      leave = t_far < leave ? t_far : leave;
    }
    return sign_mask(enter <= leave);
  }

  RAYGATE_INLINE bool goes_on(float, Rays& rays) const {
    if (rays.lanes == 0) return true;  // the root
    FloatLanes enter;
    rays.lanes &= lanes_at(bvh.nodes()[rays.node], rays.child, enter);
    return rays.lanes != 0;
  }

  RAYGATE_INLINE LaneMask meet(const Bvh::Node& of, const Rays&, FloatLanes& entry) {
    node = &of;
    LaneMask met = 0;
    entry = FloatLanes{};
    for (int i = 0; i < Bvh::kWidth && of.bounds[0][0][i] <= of.bounds[1][0][i]; ++i) {
      FloatLanes enter;
      const LaneMask in = lanes_at(of, i, enter);
      lanes[i] = static_cast<std::uint8_t>(in);
      if (in == 0) continue;
      met |= 1u << i;
      entry[i] = enter[std::countr_zero(in)];
    }
    return met;
  }

  RAYGATE_INLINE Rays rays_at(int i) const {
    return {static_cast<std::uint32_t>(node - bvh.nodes().data()), static_cast<std::uint8_t>(i),
            lanes[i]};
  }
};

/// Goes on to the next leaf: false when there is none.
RAYGATE_LANES bool advance(PacketTraversal& packet, LeafVisit& visit) {
  PacketTraversal::Visitor visitor{packet, *packet.bvh_, nullptr, {}};
  Waiting<PacketTraversal::Rays> leaf;
  if (!next_leaf(*packet.bvh_, visitor, packet.stack_, leaf)) return false;
  visit = {leaf.child.first, leaf.child.count, leaf.rays.lanes};
  return true;
}

std::optional<LeafVisit> PacketTraversal::next_leaf() {
  LeafVisit visit;
  return advance(*this, visit) ? std::optional(visit) : std::nullopt;
}

}  // namespace raygate
