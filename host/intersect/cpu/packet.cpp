#include "host/intersect/cpu/packet.h"

#include <algorithm>
#include <cstddef>

namespace raygate {
namespace {

constexpr int kGroups = RayPacket::kGroups;

/// Returns the axis on which the smallest component of the active rays is largest, or -1 if it is
/// below 1/4 on every axis.
RAYGATE_INLINE int t_scale_axis(const RayPacket& block, const LaneMask* active) {
  FloatLanes least[3] = {FloatLanes{} + 4.0f, FloatLanes{} + 4.0f, FloatLanes{} + 4.0f};
  for (int g = 0; g < kGroups; ++g) {
    if (active[g] == 0) continue;
    const IntLanes taken = lanes_of(active[g]);
    for (int k = 0; k < 3; ++k) {
      const FloatLanes size = taken ? absolute(block.direction[k][g]) : FloatLanes{} + 4.0f;
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

/// Returns in lane g the largest lane of each[g]. There must be no NaN.
RAYGATE_INLINE FloatLanes largest_of_each(const FloatLanes (&each)[kGroups]) {
  FloatLanes pairs[4], fours[2];
  for (std::size_t i = 0; i < 4; ++i) {
    const FloatLanes &a = each[2 * i], &b = each[2 * i + 1];
    const FloatLanes even = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    const FloatLanes odd = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    pairs[i] = even > odd ? even : odd;  // a b a b | a b a b
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const FloatLanes &a = pairs[2 * i], &b = pairs[2 * i + 1];
    const FloatLanes low = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
    const FloatLanes high = __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    fours[i] = low > high ? low : high;  // a b c d | a b c d
  }
  const FloatLanes low = __builtin_shufflevector(fours[0], fours[1], 0, 1, 2, 3, 8, 9, 10, 11);
  const FloatLanes high = __builtin_shufflevector(fours[0], fours[1], 4, 5, 6, 7, 12, 13, 14, 15);
  return low > high ? low : high;
}

/// Loads the directions of four rays, transposed. Each load includes the float before the
/// direction, which belongs to the same ray.
RAYGATE_INLINE void load_directions(const Ray* const (&rays)[kQuad], FloatQuad (&components)[3]) {
  static_assert(offsetof(Ray, direction) + sizeof(Ray::direction) == sizeof(Ray));
  FloatQuad rows[kQuad];
  for (int i = 0; i < kQuad; ++i)
    rows[i] = load<FloatQuad>(reinterpret_cast<const float*>(rays[i] + 1) - kQuad);
  transpose(rows);
  for (int k = 0; k < 3; ++k) components[k] = rows[k + 1];
}

}  // namespace

std::uint64_t load_packet(std::span<const Ray> rays, RayPacket& block) {
  return in_vectors([&](auto) RAYGATE_BODY {
    LaneMask positive[3] = {}, negative[3] = {};  // whether any ray is
    std::uint64_t unscaled = 0;
    for (int group = 0; group < kGroups; ++group) {
      const std::size_t begin = std::size_t(group) * kLanes;
      const std::size_t count =
          begin < rays.size() ? std::min<std::size_t>(kLanes, rays.size() - begin) : 0;
      const Ray* of[2][kQuad];  // beyond the end: the last ray
      for (std::size_t i = 0; i < kLanes; ++i) {
        of[i / kQuad][i % kQuad] = &rays[std::min(begin + i, rays.size() - 1)];
      }
      FloatQuad half[2][3];
      load_directions(of[0], half[0]);
      load_directions(of[1], half[1]);
      IntLanes largest = {};  // largest magnitude of each ray, as bits of a float
      for (int k = 0; k < 3; ++k) {
        const FloatLanes d =
            __builtin_shufflevector(half[0][k], half[1][k], 0, 1, 2, 3, 4, 5, 6, 7);
        block.direction[k][group] = d;
        block.negative[k][group] = sign_mask(d < 0.0f);
        const IntLanes size = reinterpret_cast<IntLanes>(d) & 0x7FFFFFFF;
        largest = size > largest ? size : largest;
      }
      const LaneMask usable =
          ((1u << count) - 1) & ~sign_mask((largest >= 0x7F800000) | (largest == 0));
      const IntLanes scaled = (largest >= 0x3F800000) & (largest < 0x40000000);
      block.usable[group] = usable;
      unscaled |= std::uint64_t{usable & ~sign_mask(scaled)} << (8 * group);
      for (int k = 0; k < 3; ++k) {
        positive[k] |= usable & ~block.negative[k][group];
        negative[k] |= usable & block.negative[k][group];
      }
    }
    block.octants = 0;
    for (int octant = 0; octant < 8; ++octant) {
      bool possible = true;
      for (int k = 0; k < 3; ++k) {
        possible = possible && ((octant >> k & 1) != 0 ? negative[k] : positive[k]) != 0;
      }
      if (possible) block.octants |= 1u << octant;
    }
    return unscaled;
  });
}

void make_cones(const RayPacket& block, const glm::vec3& origin, int octant, Cones& cones) {
  in_vectors([&](auto) RAYGATE_BODY {
    // Each rounding changes a value by a factor of at most 1 + 2^-24. Components over a t_scale are
    // below 8, so after two roundings their error is below kScaleError.
    constexpr float kScaleError = 0x1p-20f;
    constexpr float kUp = 1.0f + 0x1p-21f, kDown = 1.0f - 0x1p-21f;
    cones.groups = 0;
    FloatLanes off[3][kGroups];
    const int axis = t_scale_axis(block, cones.active);
    for (int g = 0; g < kGroups; ++g) {
      const LaneMask active = cones.active[g];
      if (active == 0) {
        for (int k = 0; k < 3; ++k) {
          cones.center[k][g] = 0.0f;
          off[k][g] = FloatLanes{};
        }
        continue;
      }
      cones.groups |= 1u << g;
      const int low = std::countr_zero(active), high = 31 - std::countl_zero(active);
      const IntLanes taken = lanes_of(active);
      FloatLanes t_scale = FloatLanes{} + 1.0f;
      if (axis >= 0) {
        const FloatLanes size = absolute(block.direction[axis][g]);
        t_scale = taken ? size : t_scale;
      }
      cones.t_scale[g] = t_scale;
      const FloatLanes inverse = 1.0f / t_scale;
      for (int k = 0; k < 3; ++k) {
        const FloatLanes d = block.direction[k][g] * inverse;
        const float middle = 0.5f * (d[low] + d[high]);
        cones.center[k][g] = middle;
        const FloatLanes distance = absolute(d - middle);
        off[k][g] = taken ? distance : FloatLanes{};
      }
    }
    cones.whole.octant = octant;
    const IntLanes present = lanes_of(cones.groups);
    for (int k = 0; k < 3; ++k) {
      cones.radius[k] = present ? kUp * largest_of_each(off[k]) + kScaleError : FloatLanes{};
      const FloatLanes size = absolute(cones.center[k]);
      const FloatLanes largest = (size + cones.radius[k]) * kUp;
      FloatLanes smallest = (size - cones.radius[k]) * kDown;
      smallest = smallest > 0.0f ? smallest : FloatLanes{};
      cones.bounds8.set(k, octant, smallest, largest);
      // The inverse of the largest value is the smallest, and vice versa.
      const float sign = (octant >> k & 1) != 0 ? -1.0f : 1.0f;
      const FloatLanes never = FloatLanes{} - std::numeric_limits<float>::infinity();
      const FloatLanes near = present ? -sign * cones.bounds8.inverse_near[k] : never;
      const FloatLanes far = present ? sign * cones.bounds8.inverse_far[k] : never;
      cones.whole.origin[k] = origin[k];
      cones.whole.inverse_near[k] = -sign * largest_of(near);
      cones.whole.inverse_far[k] = sign * largest_of(far);
    }
  });
}

}  // namespace raygate
