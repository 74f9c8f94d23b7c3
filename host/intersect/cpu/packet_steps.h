// Steps of a packet: finds which of its rays enter which children of a node, and tests leaves: a
// triangle against eight rays or, if few rays reach the leaf, a ray against four triangles.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include "host/intersect/cpu/packet.h"
#include "host/intersect/cpu/quad_test.h"

// Why a group never skips a triangle wrongly
//
// Let F be an edge's words, E the exact edge, b its bound, L and u as in quad_test.h, C the
// group's centre and R its radius, and I the direction of one of its rays, divided by the ray's
// t_scale; components are below 8.
// As derived there for components below 2, float32(C . F) differs from C . E by less than 8 (4 +
// 3.001) u L + 2^-143 < 3.9 b, and b >= kQuadBound u L. And |I . E - C . E| <= R |E|_1 <= R L (1 +
// 4 u). So if float32(C . F) < -b (4.1 + R / (kQuadBound u)), I . E < 0 for all the group's rays:
// all are outside of the edge and miss. `slack`, the factor of b, is rounded up by a factor of 1 +
// 2^-20, which covers the rounding of slack and of the product.

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

/// Computes I . E, or I . N, for eight directions.
RAYGATE_INLINE void side_of(const FloatLanes& x, const FloatLanes& y, const FloatLanes& z,
                            const QuadRecord& record, int plane, int triangle, FloatLanes& side) {
  side = (x * record.word(plane, 0, triangle) + y * record.word(plane, 1, triangle)) +
         z * record.word(plane, 2, triangle);
}

/// Computes the least value of the three edges.
RAYGATE_INLINE void worst_side_of(const FloatLanes& x, const FloatLanes& y, const FloatLanes& z,
                                  const QuadRecord& record, int triangle, FloatLanes& worst) {
  FloatLanes side;
  side_of(x, y, z, record, 0, triangle, worst);
  side_of(x, y, z, record, 1, triangle, side);
  worst = side < worst ? side : worst;
  side_of(x, y, z, record, 2, triangle, side);
  worst = side < worst ? side : worst;
}

/// Computes the factor of the edge bounds for cones of these radii.
RAYGATE_INLINE void slack_of(const FloatLanes (&radius)[3], FloatLanes& slack) {
  FloatLanes largest = radius[0] > radius[1] ? radius[0] : radius[1];
  largest = largest > radius[2] ? largest : radius[2];
  slack = static_cast<float>(1.0 + 0x1p-20) *
          (4.1f + largest * static_cast<float>(1.0 / (kQuadBound * 0x1p-24)));
}

/// Returns those of `groups` with rays that may hit the triangle.
template <Vectors kCode>
RAYGATE_INLINE LaneMask groups_near(const ConeTraversal& walk, const QuadRecord& record,
                                    int triangle, LaneMask groups) {
  if (!several(groups)) return groups;
  const FloatLanes(&center)[3] = walk.cones.center;
  FloatLanes worst;
  worst_side_of(center[0], center[1], center[2], record, triangle, worst);
  return groups & ~sign_mask<kCode>(worst < -(record.bounds[triangle] * walk.slack));
}

/// Computes bounds of t from those of |d| and of I . N, t being their quotient. Both are positive,
/// even if I . N is not in float32. There are four roundings each; a quotient that underflows is
/// between 0 and the smallest normal float.
template <class Lanes>
RAYGATE_INLINE void bound_distance(Lanes& low, Lanes& high, const Lanes& least, const Lanes& most) {
  constexpr float kUp = 1.0f + 0x1p-21f, kDown = 1.0f - 0x1p-21f;
  constexpr float kSmallest = std::numeric_limits<float>::min();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  low = kDown * low / most;
  high = kUp * high / least;
  low = low > kSmallest ? low : Lanes{};
  high = high > kSmallest ? high : Lanes{} + kSmallest;
  high = least > 0.0f ? high : Lanes{} + kInfinity;
}

/// Result of testing a group's rays against a triangle in float32.
struct GroupVerdict {
  LaneMask hit;        ///< sure hits, in front of the origin
  LaneMask open;       ///< sure hits and doubts
  IntLanes low, high;  ///< of sure hits: bounds of t, as bits of floats
};

template <Vectors kCode>
RAYGATE_INLINE void test_group(const ConeTraversal& walk, const QuadRecord& record, int triangle,
                               int group, LaneMask tested, GroupVerdict& verdict) {
  const RayPacket& block = *walk.block;
  const FloatLanes &x = block.direction[0][group], &y = block.direction[1][group],
                   &z = block.direction[2][group];
  FloatLanes worst;
  worst_side_of(x, y, z, record, triangle, worst);
  const float bound = record.bounds[triangle];
  verdict.open = tested & ~sign_mask<kCode>(worst < -bound);
  verdict.hit = 0;
  if (verdict.open == 0) return;
  verdict.hit = verdict.open & sign_mask<kCode>(worst > bound);
  FloatLanes v, low = FloatLanes{} + record.low[triangle],
                high = FloatLanes{} + record.high[triangle];
  side_of(x, y, z, record, QuadRecord::kNormal, triangle, v);
  const float v_bound = record.normal_bound[triangle];
  bound_distance(low, high, v - v_bound, v + v_bound);
  verdict.low = reinterpret_cast<IntLanes>(low);
  verdict.high = reinterpret_cast<IntLanes>(high);
}

/// Returns whether so few rays reach a leaf that tests ray by ray are faster. Without this, `make
/// speed` has 6 to 13 % fewer camera and shadow rays per second on sphere and landscape, and 11 %
/// fewer camera rays on teapot.
RAYGATE_INLINE bool is_sparse(std::uint64_t rays, LaneMask groups, std::uint32_t triangles) {
  return static_cast<std::uint32_t>(std::popcount(rays)) <
         2 * static_cast<std::uint32_t>(std::popcount(groups)) * triangles;
}

/// Result like that of test_group, for one ray and the leaf's triangles, one per lane.
struct RayVerdict {
  LaneMask hit, open;
  FloatQuad low, high;
};

/// Computes the sides of one direction for two planes of four triangles each.
RAYGATE_INLINE void sides_of(const float (&direction)[3], const float (&planes)[3][2][kQuad],
                             FloatQuad (&sides)[2]) {
  const FloatLanes x = load<FloatLanes>(planes[0][0]), y = load<FloatLanes>(planes[1][0]),
                   z = load<FloatLanes>(planes[2][0]);
  const FloatLanes both = (direction[0] * x + direction[1] * y) + direction[2] * z;
  sides[0] = low_half(both);
  sides[1] = high_half(both);
}

RAYGATE_INLINE void test_ray(const ConeTraversal& walk, const QuadRecord& record, int group,
                             int lane, LaneMask there, RayVerdict& verdict) {
  const auto& from = walk.block->direction;
  const float direction[3] = {from[0][group][lane], from[1][group][lane], from[2][group][lane]};
  FloatQuad first[2], second[2];
  sides_of(direction, record.planes[0], first);
  sides_of(direction, record.planes[1], second);
  FloatQuad worst = first[0] < first[1] ? first[0] : first[1];
  worst = second[0] < worst ? second[0] : worst;
  const FloatQuad bound = load<FloatQuad>(record.bounds);
  verdict.open = there & ~sign_mask(worst < -bound);
  verdict.hit = 0;
  if (verdict.open == 0) return;
  verdict.hit = verdict.open & sign_mask(worst > bound);
  const FloatQuad& v = second[1];
  const FloatQuad v_bound = load<FloatQuad>(record.normal_bound);
  FloatQuad low = load<FloatQuad>(record.low), high = load<FloatQuad>(record.high);
  bound_distance(low, high, v - v_bound, v + v_bound);
  verdict.low = low;
  verdict.high = high;
}

}  // namespace raygate
