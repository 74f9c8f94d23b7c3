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

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kFarthest = std::numeric_limits<float>::max();  // no t is, nor any entry

}  // namespace

PacketTraversal::PacketTraversal(const Bvh& bvh, int octant)
    : nodes_(bvh.nodes().data()), octant_(octant) {
  for (int lane = 0; lane < kLanes; ++lane) {
    cutoff_[lane] = -1.0f;  // below any entry: no ray
    waiting_near_[0][lane] = 0.0f;
  }
  waiting_[0] = bvh.root();
}

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

/// Goes on to the next leaf: false when there is none.
RAYGATE_LANES bool advance(PacketTraversal& packet, LeafVisit& visit) {
  const FloatLanes origin[3] = {packet.origin_[0], packet.origin_[1], packet.origin_[2]};
  const FloatLanes inverse_near[3] = {packet.inverse_near_[0], packet.inverse_near_[1],
                                      packet.inverse_near_[2]};
  const FloatLanes inverse_far[3] = {packet.inverse_far_[0], packet.inverse_far_[1],
                                     packet.inverse_far_[2]};
  const FloatLanes cutoff = packet.cutoff_;
  const FloatLanes never = FloatLanes{} + kInfinity;
  const int octant = packet.octant_;
  int depth = packet.depth_;

  while (depth > 0) {
    --depth;
    FloatLanes near = packet.waiting_near_[depth];
    Bvh::Ref ref = packet.waiting_[depth];
    LaneMask lanes = mask_of(near <= cutoff, IntLanes{});
    if (lanes == 0) continue;
    while (ref.count == 0) {
      const Bvh::Node& node = packet.nodes_[ref.first];
      FloatLanes entry[2];
      IntLanes enters[2];
      for (int side = 0; side < 2; ++side) {
        FloatLanes enter = near, leave = cutoff;
        for (int k = 0; k < 3; ++k) {
          const int negative = octant >> k & 1;
          const float near_plane = node.bounds[negative][side][k];
          const float far_plane = node.bounds[negative ^ 1][side][k];
          const FloatLanes t_near = (near_plane - origin[k]) * inverse_near[k];
          const FloatLanes t_far = (far_plane - origin[k]) * inverse_far[k];
          enter = t_near > enter ? t_near : enter;
          leave = t_far < leave ? t_far : leave;
        }
        enters[side] = enter <= leave;
        entry[side] = enters[side] ? enter : never;
      }
      const std::uint32_t masks = mask_of(enters[0], enters[1]);
      if (masks == 0) {
        lanes = 0;
        break;
      }
      const LaneMask mask[2] = {masks & 0xFF, masks >> 8};
      int first = octant >> ref.axis & 1;
      if (mask[first] == 0) first ^= 1;
      if (mask[first ^ 1] != 0) {
        packet.waiting_near_[depth] = entry[first ^ 1];
        packet.waiting_[depth++] = node.child[first ^ 1];
      }
      near = entry[first];
      ref = node.child[first];
      lanes = mask[first];
    }
    if (lanes == 0) continue;
    visit = {ref.first, ref.count, lanes};
    packet.depth_ = depth;
    return true;
  }
  packet.depth_ = 0;
  return false;
}

std::optional<LeafVisit> PacketTraversal::next_leaf() {
  LeafVisit visit;
  return advance(*this, visit) ? std::optional(visit) : std::nullopt;
}

}  // namespace raygate
