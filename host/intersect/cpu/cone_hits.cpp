// Writes the nearest hits of a finished packet, with their points P.
#include <algorithm>
#include <bit>

#include "host/intersect/cpu/packet_intersector.h"
#include "host/intersect/point_error.h"
#include "host/intersect/record_batch.h"

namespace raygate {

/// Hands the nearest hits over, with their P where that is asked for: triangle by triangle, as rays
/// that hit one share its plane.
void PacketIntersector::finish(const ConeTraversal& walk) {
  in_vectors([&](auto) RAYGATE_BODY {
    if (!query_.work.empty()) put_work(walk);
    std::uint64_t left = 0;
    for (LaneMask groups = walk.cones.groups; groups != 0; groups &= groups - 1) {
      const int g = std::countr_zero(groups);
      left |= std::uint64_t{0xFF & ~sign_mask(walk.primitive[g])} << (8 * g);
    }
    Seen seen[kPlanes];
    int count = 0;
    while (left != 0) {
      const int first = std::countr_zero(left);
      const std::int32_t primitive = walk.primitive[first / kLanes][first % kLanes];
      std::uint64_t same = 0;
      for (LaneMask groups = groups_of(left); groups != 0; groups &= groups - 1) {
        const int g = std::countr_zero(groups);
        same |= std::uint64_t{sign_mask(walk.primitive[g] == primitive)} << (8 * g);
      }
      same &= left;
      left &= ~same;
      seen[count++] = {static_cast<std::uint32_t>(primitive), same};
      if (count < kPlanes && left != 0) continue;
      if (query_.with_points()) {
        put_with_points(walk, std::span(seen, static_cast<std::size_t>(count)));
      } else {
        for (int i = 0; i < count; ++i) put(walk, seen[i]);
      }
      count = 0;
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

RAYGATE_INLINE void PacketIntersector::put(const ConeTraversal& walk, const Seen& seen) {
  for (std::uint64_t rays = seen.rays; rays != 0; rays &= rays - 1) {
    const int ray = std::countr_zero(rays), g = ray / kLanes, lane = ray % kLanes;
    hits_[walk.number(g, lane)] = {.primitive = seen.primitive, .t = walk.t(g, lane)};
  }
}

/// P has the bits of plane_point.
RAYGATE_INLINE void PacketIntersector::put_with_points(const ConeTraversal& walk,
                                                       std::span<const Seen> seen) {
  PlaneViews views;
  for (std::size_t i = 0; i < kPlanes; ++i) {
    views.set(i, origin_, bvh_.corners_of(seen[std::min(i, seen.size() - 1)].primitive));
  }
  Planes planes;
  make_planes(views, planes);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const PolygonRecord plane = planes.record(i);
    const float n[3] = {plane.normal.x, plane.normal.y, plane.normal.z};
    const IntLanes largest = IntLanes{} + largest_field(plane.normal);
    for (LaneMask groups = groups_of(seen[i].rays); groups != 0; groups &= groups - 1) {
      const int g = std::countr_zero(groups);
      const auto& from = walk.block->direction;
      FloatLanes point[3];
      IntLanes error_bits;
      plane_points(n, plane.d, largest, {from[0][g], from[1][g], from[2][g]}, point, error_bits);
      const FloatLanes error = float_of(error_bits);
      for (LaneMask lanes = rays_of(seen[i].rays, g); lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        hits_[walk.number(g, lane)] = {seen[i].primitive,
                                       glm::vec3(point[0][lane], point[1][lane], point[2][lane]),
                                       error[lane], walk.t(g, lane)};
      }
    }
    counters_.hit.plane_tests += static_cast<std::uint64_t>(std::popcount(seen[i].rays));
  }
}

}  // namespace raygate
