#include "host/render/cone.h"

#include <algorithm>
#include <bit>

#include "host/hit/exact.h"
#include "host/render/lane_math.h"

namespace raygate {
namespace {

constexpr int kGroups = RayBlock::kGroups;

/// The axis along which the active rays go farthest, by the one that goes least; -1 where that is
/// less than 1/4 on every axis.
RAYGATE_INLINE int pace_axis(const RayBlock& block, const LaneMask* active) {
  FloatLanes least[3] = {FloatLanes{} + 4.0f, FloatLanes{} + 4.0f, FloatLanes{} + 4.0f};
  for (int g = 0; g < kGroups; ++g) {
    if (active[g] == 0) continue;
    IntLanes taken;
    lanes_of(active[g], taken);
    for (int k = 0; k < 3; ++k) {
      FloatLanes size;
      magnitude(block.direction[k][g], size);
      size = taken ? size : FloatLanes{} + 4.0f;
      least[k] = size < least[k] ? size : least[k];
    }
  }
  int axis = -1;
  float best = 0.25f;
  for (int k = 0; k < 3; ++k) {
    const float smallest = -largest_of(-least[k]);
    if (smallest >= best) {
      best = smallest;
      axis = k;
    }
  }
  return axis;
}

}  // namespace

RAYGATE_LANES void load_block(std::span<const Ray> rays, RayBlock& block) {
  block.octants = 0;
  for (int group = 0; group < kGroups; ++group) {
    const std::size_t begin = std::size_t(group) * kLanes;
    const std::size_t count =
        begin < rays.size() ? std::min<std::size_t>(kLanes, rays.size() - begin) : 0;
    const Ray* of[kLanes];  // past the end: the last one
    for (std::size_t i = 0; i < kLanes; ++i) of[i] = &rays[std::min(begin + i, rays.size() - 1)];
    IntLanes unusable = {}, zero = IntLanes{} - 1;
    for (int k = 0; k < 3; ++k) {
      const FloatLanes d = {of[0]->direction[k], of[1]->direction[k], of[2]->direction[k],
                            of[3]->direction[k], of[4]->direction[k], of[5]->direction[k],
                            of[6]->direction[k], of[7]->direction[k]};
      block.direction[k][group] = d;
      block.negative[k][group] = sign_mask(d < 0.0f);
      const IntLanes size = reinterpret_cast<IntLanes>(d) & 0x7FFFFFFF;
      unusable |= size >= 0x7F800000;
      zero &= size == 0;
    }
    LaneMask left = block.usable[group] = ((1u << count) - 1) & ~sign_mask(unusable | zero);
    while (left != 0) {
      const int lane = std::countr_zero(left);
      int octant = 0;
      for (int k = 0; k < 3; ++k)
        octant |= static_cast<int>(block.negative[k][group] >> lane & 1) << k;
      block.octants |= 1u << octant;
      left &= ~block.into_octant(octant, group);
    }
  }
}

RAYGATE_LANES void make_cones(const RayBlock& block, const glm::vec3& origin, int octant,
                              Cones& cones) {
  // Each rounding of what follows is off by a factor 1 + 2^-24 at most. Components over a pace are
  // below 8, so that two roundings have them off by less than kPaceError.
  constexpr float kPaceError = 0x1p-20f;
  constexpr float kUp = 1.0f + 0x1p-21f, kDown = 1.0f - 0x1p-21f;
  cones.groups = 0;
  for (int k = 0; k < 3; ++k) cones.center[k] = cones.radius[k] = FloatLanes{};
  const int axis = pace_axis(block, cones.active);
  for (int g = 0; g < kGroups; ++g) {
    const LaneMask active = cones.active[g];
    if (active == 0) continue;
    cones.groups |= 1u << g;
    const int low = std::countr_zero(active), high = 31 - std::countl_zero(active);
    IntLanes taken;
    lanes_of(active, taken);
    FloatLanes pace = FloatLanes{} + 1.0f;
    if (axis >= 0) {
      FloatLanes size;
      magnitude(block.direction[axis][g], size);
      pace = taken ? size : pace;
    }
    cones.pace[g] = pace;
    const FloatLanes inverse = 1.0f / pace;
    for (int k = 0; k < 3; ++k) {
      const FloatLanes d = block.direction[k][g] * inverse;
      const float middle = 0.5f * (d[low] + d[high]);
      cones.center[k][g] = middle;
      FloatLanes off;
      magnitude(d - middle, off);
      off = taken ? off : FloatLanes{};
      cones.radius[k][g] = kUp * largest_of(off) + kPaceError;
    }
  }
  cones.whole.octant = octant;
  IntLanes present;
  lanes_of(cones.groups, present);
  for (int k = 0; k < 3; ++k) {
    FloatLanes size;
    magnitude(cones.center[k], size);
    const FloatLanes largest = (size + cones.radius[k]) * kUp;
    FloatLanes smallest = (size - cones.radius[k]) * kDown;
    smallest = smallest > 0.0f ? smallest : FloatLanes{};
    cones.beams.set(k, octant, smallest, largest);
    // The inverse of the largest is the smallest, and the other way round.
    const float sign = (octant >> k & 1) != 0 ? -1.0f : 1.0f;
    const FloatLanes never = FloatLanes{} - std::numeric_limits<float>::infinity();
    const FloatLanes near = present ? -sign * cones.beams.inverse_near[k] : never;
    const FloatLanes far = present ? sign * cones.beams.inverse_far[k] : never;
    cones.whole.origin[k] = origin[k];
    cones.whole.inverse_near[k] = -sign * largest_of(near);
    cones.whole.inverse_far[k] = sign * largest_of(far);
  }
}

}  // namespace raygate
