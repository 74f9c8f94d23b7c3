// Node step of a packet: finds which of its rays enter which children.
#pragma once

#include <bit>
#include <limits>

#include "host/bvh/packet_traversal.h"
#include "host/intersect/cpu/cone_traversal.h"

namespace raygate {

/// Computes the tightest PacketBounds8 around each ray of a group.
RAYGATE_INLINE void split_group(ConeTraversal& walk, int group) {
  PacketBounds8& bounds8 = walk.ray_bounds8[group];
  constexpr float kUp = 1.0f + 0x1p-21f, kDown = 1.0f - 0x1p-21f;
  const FloatLanes inverse = 1.0f / walk.cones.t_scale[group];
  for (int k = 0; k < 3; ++k) {
    const FloatLanes size = absolute(walk.block->direction[k][group] * inverse);
    bounds8.set(k, walk.cones.whole.octant, size * kDown, size * kUp);
  }
  cutoffs_beyond(walk.high[group], walk.cones.t_scale[group], walk.cones.active[group],
                 bounds8.cutoff);
  walk.split |= 1u << group;
}

/// Returns the children that any of `rays`, in `groups`, may meet; entry[i] is the distance.
template <Vectors kCode>
RAYGATE_INLINE LaneMask meet_any(const ConeTraversal& walk, const Bvh::Node& node,
                                 std::uint64_t rays, LaneMask groups, FloatLanes& entry) {
  const Cones& cones = walk.cones;
  if (several(groups)) return intersect_children<kCode>(cones.whole, node, walk.cutoff, entry);
  const int only = std::countr_zero(groups);
  if (several(rays) || (walk.split >> only & 1) == 0) {
    const PacketBounds bounds = bounds_of(cones.bounds8, only, cones.whole);
    return intersect_children<kCode>(bounds, node, cones.bounds8.cutoff[only], entry);
  }
  const int lane = std::countr_zero(rays_of(rays, only));
  const PacketBounds8& bounds8 = walk.ray_bounds8[only];
  return intersect_children<kCode>(bounds_of(bounds8, lane, cones.whole), node,
                                   bounds8.cutoff[lane], entry);
}

/// Inserts a child of a node into the stack, sorted by entry distance down to `bottom`.
RAYGATE_INLINE void push(ConeTraversal& walk, const BvhView& tree, int bottom,
                         const ConeTraversal::StackEntry& next) {
  tree.prefetch(next.child);
  int place = walk.depth++;
  for (; place > bottom && walk.stack[place - 1].entry < next.entry; --place) {
    walk.stack[place] = walk.stack[place - 1];
  }
  walk.stack[place] = next;
}

/// Up to this number of rays in several groups pass a node one by one. Without this, `build/lab
/// rays` has 0.7 times the light rays per second on sphereflake, 0.85 on landscape.
constexpr int kFewRays = 8;

/// Does the work of step_through for a few rays.
template <Vectors kCode>
RAYGATE_INLINE void step_one_by_one(ConeTraversal& walk, const BvhView& tree, const Bvh::Node& node,
                                    std::uint64_t rays) {
  FloatLanes entry = FloatLanes{} + std::numeric_limits<float>::infinity();
  LaneMask met[kFewRays] = {}, any = 0;
  std::uint64_t ray[kFewRays] = {};
  int count = 0;
  for (; rays != 0; rays &= rays - 1) {
    const int number = std::countr_zero(rays), g = number / kLanes, lane = number % kLanes;
    if ((walk.split >> g & 1) == 0) split_group(walk, g);
    const PacketBounds8& bounds8 = walk.ray_bounds8[g];
    FloatLanes its_entry;
    met[count] = intersect_children<kCode>(bounds_of(bounds8, lane, walk.cones.whole), node,
                                           bounds8.cutoff[lane], its_entry);
    const IntLanes meets = lanes_of(met[count]);
    entry = (meets & (its_entry < entry)) ? its_entry : entry;
    any |= met[count];
    ray[count++] = rays & -rays;
  }
  const int bottom = walk.depth;
  for (; any != 0; any &= any - 1) {
    const int i = std::countr_zero(any);
    std::uint64_t its_rays = 0;
    for (int r = 0; r < kFewRays; ++r) its_rays |= (met[r] >> i & 1) != 0 ? ray[r] : 0;
    push(walk, tree, bottom, {node.child[i], entry[i], its_rays});
  }
}

/// Pushes the children of a node that the rays meet. If the cone meets several children, its groups
/// are tested one by one, then the rays of those groups.
///
/// Cones do not use next_leaf (host/bvh/traversal.h): a visitor for it reached 0.88 of the shadow
/// rays per second and 0.93 of the camera rays (`build/lab rays landscape.obj`).
template <Vectors kCode>
RAYGATE_INLINE void step_through(ConeTraversal& walk, const BvhView& tree, std::uint32_t index,
                                 std::uint64_t rays, LaneMask groups) {
  constexpr int kFew = 1;  // children
  Bvh::Node room;
  const Bvh::Node& node = tree.node(index, room);
  if (several(groups) && std::popcount(rays) <= kFewRays) {
    step_one_by_one<kCode>(walk, tree, node, rays);
    return;
  }
  const Cones& cones = walk.cones;
  const PacketBounds& whole = cones.whole;
  const glm::vec3 origin(whole.origin[0], whole.origin[1], whole.origin[2]);
  FloatLanes entry;
  LaneMask met = meet_any<kCode>(walk, node, rays, groups, entry);
  LaneMask in[Bvh::kWidth];
  const bool ask = several(groups) && std::popcount(met) > kFew;
  std::uint64_t counts = 0;  // byte g: number of children that group g meets
  for (LaneMask left = met; left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    in[i] = groups;
    if (ask || (several(groups) && node.child[i].count != 0)) {
      in[i] &= intersect_packets<kCode>(cones.bounds8, origin, whole.octant, node, i);
    }
    counts += ones_of(in[i]);
  }
  LaneMask divided = groups_of((counts + (0x7F - kFew) * ones_of(0xFF)) & 0x80 * ones_of(0xFF));
  for (LaneMask left = divided; left != 0; left &= left - 1) {
    const int g = std::countr_zero(left);
    if (!several(rays_of(rays, g))) {
      divided &= ~(1u << g);
    } else if ((walk.split >> g & 1) == 0) {
      split_group(walk, g);
    }
  }
  const int bottom = walk.depth;
  for (; met != 0; met &= met - 1) {
    const int i = std::countr_zero(met);
    ConeTraversal::StackEntry next = {node.child[i], entry[i], rays & 0xFF * ones_of(in[i])};
    for (LaneMask left = divided & in[i]; left != 0; left &= left - 1) {
      const int g = std::countr_zero(left);
      const std::uint64_t missed =
          0xFF & ~intersect_packets<kCode>(walk.ray_bounds8[g], origin, whole.octant, node, i);
      next.rays &= ~(missed << (8 * g));
    }
    if (next.rays == 0) continue;
    push(walk, tree, bottom, next);
  }
}

}  // namespace raygate
