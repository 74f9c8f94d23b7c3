// Writes the nearest hits of a finished packet, with their points P.
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "host/intersect/cpu/packet_intersector.h"
#include "host/intersect/point_error.h"
#include "host/intersect/polygon_record.h"

namespace raygate {

/// Planes of the triangles that the rays of a packet hit.
struct PacketIntersector::SeenPlanes {
  static constexpr int kMost = RayPacket::kRays;

  int count = 0;
  std::uint32_t primitives[kMost + 1] = {};
  std::uint8_t of_rays[RayPacket::kGroups][kLanes] = {};  ///< index of each ray's plane
  LaneMask even = 0;                                      ///< groups whose rays hit the same plane
  float words[4][kMost];                                  ///< in the format of Planes
  std::int32_t largest[kMost];                            ///< exponent field of N

  /// Returns a value of the planes that a group's rays hit, one per lane.
  template <class Word>
  [[nodiscard]] RAYGATE_INLINE auto get(const Word (&of)[kMost], int group) const {
    const std::uint8_t(&at)[kLanes] = of_rays[group];
    if ((even >> group & 1) != 0) return Vec<Word, kLanes>{} + of[at[0]];
    return Vec<Word, kLanes>{of[at[0]], of[at[1]], of[at[2]], of[at[3]],
                             of[at[4]], of[at[5]], of[at[6]], of[at[7]]};
  }
};

/// Sets pairs[i] to {first[i], second[i]}.
RAYGATE_INLINE void pair_up(const DoubleQuad& first, const DoubleQuad& second,
                            Vec<double, 2>* pairs) {
  pairs[0] = __builtin_shufflevector(first, second, 0, 4);
  pairs[1] = __builtin_shufflevector(first, second, 1, 5);
  pairs[2] = __builtin_shufflevector(first, second, 2, 6);
  pairs[3] = __builtin_shufflevector(first, second, 3, 7);
}

/// Writes the nearest hits, with P if requested.
void PacketIntersector::finish(const ConeTraversal& walk) {
  in_vectors([&](auto) RAYGATE_BODY {
    if (!query_.work.empty()) put_work(walk);
    std::uint64_t rays = 0;  // rays with a hit
    for (LaneMask groups = walk.cones.groups; groups != 0; groups &= groups - 1) {
      const int g = std::countr_zero(groups);
      rays |= std::uint64_t{0xFF & ~sign_mask(walk.primitive[g])} << (8 * g);
    }
    if (query_.with_points()) {
      put_with_points(walk, rays);
    } else {
      put(walk, rays);
    }
  });
}

void PacketIntersector::put_work(const ConeTraversal& walk) {
  for (int g = 0; g < ConeTraversal::kGroups; ++g) {
    for (LaneMask lanes = walk.started[g]; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      query_.work[walk.number(g, lane)] = walk.work[g][lane];
    }
  }
}

RAYGATE_INLINE void PacketIntersector::put(const ConeTraversal& walk, std::uint64_t rays) {
  for (; rays != 0; rays &= rays - 1) {
    const int ray = std::countr_zero(rays), g = ray / kLanes, lane = ray % kLanes;
    hits_[walk.number(g, lane)] = {.primitive = static_cast<std::uint32_t>(walk.primitive[g][lane]),
                                   .t = walk.t(g, lane)};
  }
}

/// Collects the planes that these rays hit, mostly without duplicates.
RAYGATE_INLINE void PacketIntersector::find_planes(const ConeTraversal& walk, std::uint64_t rays,
                                                   SeenPlanes& planes) const {
  std::uint8_t last[SeenPlanes::kMost] = {};  // by hash: the last plane of a primitive
  const auto number_of = [&](std::int32_t hit) __attribute__((always_inline)) {
    const auto primitive = static_cast<std::uint32_t>(hit);
    std::uint8_t& number = last[primitive % SeenPlanes::kMost];
    // Branchless, as a branch would be unpredictable.
    const int known =
        (number < planes.count ? 1 : 0) & (planes.primitives[number] == primitive ? 1 : 0);
    number = static_cast<std::uint8_t>(known != 0 ? number : planes.count);
    planes.primitives[planes.count] = primitive;
    planes.count += 1 - known;
    return number;
  };
  for (LaneMask groups = groups_of(rays); groups != 0; groups &= groups - 1) {
    const int g = std::countr_zero(groups);
    const IntLanes& hits = walk.primitive[g];
    std::uint8_t(&of)[kLanes] = planes.of_rays[g];
    if (sign_mask(hits == hits[0]) == 0xFF) {
      planes.even |= 1u << g;
      of[0] = number_of(hits[0]);
      continue;
    }
    for (LaneMask lanes = rays_of(rays, g); lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      of[lane] = number_of(hits[lane]);
    }
  }
  for (int first = 0; first < planes.count; first += kPlanes) {
    PlaneViews views;
    for (int i = 0; i < kPlanes; ++i) {
      views.origins[i] = origin_;
      views.triangles[i] =
          bvh_.corners_of(planes.primitives[std::min(first + i, planes.count - 1)]);
    }
    Planes four;
    make_planes(views, four);
    IntQuad largest = {};
    for (int k = 0; k < 4; ++k) {
      const auto words = load<FloatQuad>(four.words[k]);
      std::memcpy(&planes.words[k][first], &words, sizeof words);
      if (k < 3) largest = maximum(largest, bits_in(words) >> 23 & 0xFF);
    }
    std::memcpy(&planes.largest[first], &largest, sizeof largest);
  }
}

/// Writes hits with P, which has the bits of plane_point.
RAYGATE_INLINE void PacketIntersector::put_with_points(const ConeTraversal& walk,
                                                       std::uint64_t rays) {
  SeenPlanes planes;
  find_planes(walk, rays, planes);
  counters_.hit.plane_tests += static_cast<std::uint64_t>(std::popcount(rays));
  for (LaneMask groups = groups_of(rays); groups != 0; groups &= groups - 1) {
    const int g = std::countr_zero(groups);
    const FloatLanes n[3] = {planes.get(planes.words[0], g), planes.get(planes.words[1], g),
                             planes.get(planes.words[2], g)};
    const auto& from = walk.block->direction;
    FloatLanes point[3];
    IntLanes error_bits;
    plane_points(n, planes.get(planes.words[3], g), planes.get(planes.largest, g),
                 {from[0][g], from[1][g], from[2][g]}, point, error_bits);
    // The words to be written for each ray.
    const FloatLanes error = float_of(error_bits), primitive = float_of(walk.primitive[g]);
    FloatQuad rows[2][kQuad] = {
        {low_half(primitive), low_half(point[0]), low_half(point[1]), low_half(point[2])},
        {high_half(primitive), high_half(point[0]), high_half(point[1]), high_half(point[2])}};
    transpose(rows[0]);
    transpose(rows[1]);
    const FloatLanes low = float_of(walk.low[g]), high = float_of(walk.high[g]);
    Vec<double, 2> t[kLanes];
    pair_up(wide(low_half(low)), wide(low_half(high)), t);
    pair_up(wide(high_half(low)), wide(high_half(high)), t + kQuad);
    NearestHit* const hits = &hits_[walk.number(g, 0)];
    const auto write = [&](int lane) __attribute__((always_inline)) {
      static_assert(offsetof(NearestHit, primitive) == 0 && offsetof(NearestHit, point) == 4);
      std::memcpy(static_cast<void*>(&hits[lane]), &rows[lane / kQuad][lane % kQuad], 16);
      hits[lane].point_error = error[lane];
      std::memcpy(&hits[lane].t, &t[lane], sizeof t[lane]);
    };
    LaneMask lanes = rays_of(rays, g);
    if (lanes == 0xFF) {
      for (int lane = 0; lane < kLanes; ++lane) write(lane);
    } else {
      for (; lanes != 0; lanes &= lanes - 1) write(std::countr_zero(lanes));
    }
  }
}

}  // namespace raygate
