#include "host/bvh/packet_traversal.h"

#include <bit>
#include <cassert>
#include <limits>

#include "host/bvh/sah_builder.h"

// Why no true hit is culled
//
// Let the ray hit a triangle at t* > 0, t* at most the exact cutoff, I its direction, and u =
// 2^-24. On each axis t* I = x - O for a coordinate x inside the triangle's box, which the BVH
// stores at least one float, so at least 2^-149, wider: low' + 2^-149 <= x <= high' - 2^-149. By
// symmetry let I > 0; near = low', far = high'.
//
// Entry: float32((near - O) * inverse_near). A difference of floats has a relative error of u and
// never underflows; with |coordinates| <= 2^126 it does not overflow.
//   * I >= 2^-100: inverse_near = float32(1/I), a normal number with a relative error of u. The
//     product has a relative error of u, or an error of 2^-150 if it underflows; (near - O) <= t* I
//     - 2^-149 and 1/I > 1/2, so the widening covers the 2^-150, and the entry is at most t* (1 +
//     3.1 u), or negative. The product overflows only if t* > 2^127, but on the axis of the largest
//     I, in [1, 2), t* <= 2^127.
//   * I < 2^-100, or 0: inverse_near = 2^100 <= 1/I, so a positive entry is no later than above,
//     and a negative or zero one never later than 0. With I = 0, near - O < 0.
// Exit: float32((far - O) * inverse_far).
//   * I >= 2^-100: inverse_far = float32((1 + 8 u) float32(1/I)) (Ize, "Robust BVH ray traversal",
//     2013, grows the exit likewise). Four roundings: the exit is at least t* (1 + 8 u) (1 - u)^4 >
//     t* (1 + 3.9 u); underflow is covered as above.
//   * I < 2^-100: inverse_far = +infinity, and far - O > 0: the exit is +infinity.
// Cutoff: stored as t (1 + 8 u), rounded up; finite, so that an entry of +infinity means that the
// ray does not enter.
// So the entry of every axis <= t* (1 + 3.1 u) < the exit of every axis and the cutoff, and the box
// is visited.
//
// A product may be 0 * infinity = NaN (far = O, I = 0: a ray within a face that the widening has
// moved away from its triangle). Comparisons are written so that a NaN is ignored.

namespace raygate {
namespace {

constexpr float kFarthest = std::numeric_limits<float>::max();  // larger than any t or entry

}  // namespace

PacketTraversal::PacketTraversal(const Bvh& bvh, int octant) : bvh_(&bvh), octant_(octant) {
  rays_.cutoff = FloatLanes{} - 1.0f;  // below any entry, as there is no ray yet
  stack_[0] = {{0, 0}, 0.0f, 0xFF};
}

void PacketTraversal::set_ray(int lane, const glm::vec3& origin, const glm::vec3& direction) {
  assert(octant_of(direction) == octant_);
  rays_.cutoff[lane] = kFarthest;
  const PacketBounds bounds(origin, direction);
  for (int k = 0; k < 3; ++k) {
    origin_[k][lane] = origin[k];
    rays_.inverse_near[k][lane] = bounds.inverse_near[k];
    rays_.inverse_far[k][lane] = bounds.inverse_far[k];
  }
}

void PacketTraversal::set_cutoff(int lane, double t) { rays_.cutoff[lane] = cutoff_beyond(t); }

/// Returns the rays that meet the box of one triangle of a leaf.
RAYGATE_INLINE LaneMask PacketTraversal::meet(const FloatCorners& corners) const {
  const Box box = box_around(corners[0], corners[1], corners[2]);
  float near[3], far[3];
  for (int k = 0; k < 3; ++k) {
    const bool negative = (octant_ >> k & 1) != 0;
    near[k] = negative ? -box[k + 4] : box[k];
    far[k] = negative ? box[k] : -box[k + 4];
  }
  FloatLanes enter;
  return intersect_box(rays_, origin_, near, far, enter);
}

LeafVisits PacketTraversal::next_leaf() {
  LeafVisits leaf;
  in_vectors([&](auto) RAYGATE_BODY {
    const BvhView tree(*bvh_);
    while (leaf.count == 0 && depth_ > 0) {
      const StackEntry at = stack_[--depth_];
      if ((at.lanes & sign_mask(rays_.cutoff >= at.entry)) == 0) continue;
      const std::uint32_t end = at.child.first + at.child.count;
      for (std::uint32_t primitive = at.child.first; primitive < end; ++primitive) {
        const LaneMask lanes = meet(bvh_->float_corners_of(primitive));
        if (lanes == 0) continue;
        LeafVisit* const last = leaf.count == 0 ? nullptr : &leaf.visits[leaf.count - 1];
        if (last != nullptr && last->lanes == lanes && last->first + last->count == primitive) {
          ++last->count;
        } else {
          leaf.visits[leaf.count++] = {primitive, 1, lanes};
        }
      }
      if (at.child.count != 0) continue;
      Bvh::Node room;
      const Bvh::Node& node = tree.node(at.child.first, room);
      const int bottom = depth_;
      for (int i = 0; i < Bvh::kWidth && node.bounds[0][0][i] <= node.bounds[1][0][i]; ++i) {
        FloatLanes enter;
        StackEntry child = {node.child[i], 0.0f, 0};
        child.lanes = intersect_child(rays_, origin_, octant_, node, i, enter);
        if (child.lanes == 0) continue;
        tree.prefetch(child.child);
        enter = enter <= rays_.cutoff ? enter : FloatLanes{} + kFarthest;
        // Sorts as the hardware sorts: by entry without its last three bits, then by index.
        child.entry = std::bit_cast<float>(std::bit_cast<std::int32_t>(-largest_of(-enter)) & ~7);
        int place = depth_++;
        for (; place > bottom && stack_[place - 1].entry <= child.entry; --place) {
          stack_[place] = stack_[place - 1];
        }
        stack_[place] = child;
      }
    }
  });
  return leaf;
}

}  // namespace raygate
