#include "host/bvh/packet_traversal.h"

#include <bit>
#include <cassert>
#include <limits>

#include "host/bvh/sah_builder.h"

// Why no true hit is culled
//
// Let a ray hit a triangle at the exact distance t* > 0, and let t >= t* be the ray's cutoff. To
// show: no axis has an entry later than t* (1 + 3.1 u), and exits and stored cutoff are later than
// that. Here u = 2^-24 is the unit roundoff of binary32.
//
// On one axis, let O and I be the coordinates of origin and direction. By symmetry let I >= 0. The
// hit's coordinate x = O + t* I is inside the triangle's box. The BVH stores the box [near, far]
// wider by at least one float, so by at least 2^-149: near + 2^-149 <= x <= far - 2^-149.
//
// Entry: float32((near - O) * inverse_near). A difference of floats has a relative error of u. It
// never underflows, and does not overflow because |coordinates| <= 2^126.
//   * I >= 2^-100: inverse_near = float32(1/I) is normal and has a relative error of u. The product
//     has a relative error of u, or an error of 2^-150 if it underflows. The latter is made up for
//     by the widening: near - O <= t* I - 2^-149, and 1/I > 1/2. With three relative errors, the
//     entry is at most t* (1 + 3.1 u) or at most 0. The product overflows only if t* > 2^127, which
//     cannot be: on the axis with I in [1, 2), t* = (x - O) / I <= 2^127.
//   * I < 2^-100: inverse_near = 2^100 <= 1/I, so a positive entry is no later than for 1/I, and
//     any other one is not later than 0. If I = 0, then x = O and near - O < 0.
// Exit: float32((far - O) * inverse_far).
//   * I >= 2^-100: inverse_far = float32((1 + 8 u) float32(1/I)) (as in Ize, "Robust BVH ray
//     traversal", 2013). With four roundings, the exit is at least t* (1 + 8 u) (1 - u)^4, which is
//     more than t* (1 + 3.9 u). The widening makes up for underflow as above.
//   * I < 2^-100: inverse_far = +infinity and far - O > 0, so the exit is +infinity.
// Cutoff: stored as t (1 + 8 u), rounded up, but finite: boxes with entry +infinity are skipped.
//
// A product is 0 * infinity = NaN if far = O and I = 0: the ray is in a face of the widened box,
// outside the triangle's own box. Comparisons are written so that a NaN is ignored.

namespace raygate {

constexpr float kFarthest = std::numeric_limits<float>::max();  // larger than any finite t or entry

PacketTraversal::PacketTraversal(const Bvh& bvh, int octant) : bvh_(&bvh), octant_(octant) {
  rays_.cutoff = FloatLanes{} - 1.0f;  // below any entry, because there is no ray yet
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
        // Same order as in hardware: by entry without its last three bits, then by child index.
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
