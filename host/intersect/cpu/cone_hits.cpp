// What a cone walk found, handed over.
#include <algorithm>
#include <bit>

#include "host/intersect/cpu/packet_intersector.h"
#include "host/intersect/unit/point_error.h"
#include "host/intersect/unit/record_batch.h"

namespace raygate {

/// Hands the nearest hits over, with their P where that is asked for: triangle by triangle, as rays
/// that hit one share its plane.
void finish(PacketIntersector& intersector, const ConeTraversal& walk) {
  in_vectors([&](auto) RAYGATE_BODY {
    const bool with_points =
        intersector.query_.skip_ids.empty() && intersector.query_.any_hit_before.empty();
    if (!intersector.query_.work.empty()) intersector.put_work(walk);
    std::uint64_t left = 0;
    for (LaneMask groups = walk.cones.groups; groups != 0; groups &= groups - 1) {
      const int g = std::countr_zero(groups);
      left |= std::uint64_t{0xFF & ~sign_mask(walk.primitive[g])} << (8 * g);
    }
    PacketIntersector::Seen seen[kPlanes];
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
      if (with_points) {
        intersector.put_with_points(walk, std::span(seen, static_cast<std::size_t>(count)));
      } else {
        for (int i = 0; i < count; ++i) intersector.put(walk, seen[i]);
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
    const glm::vec3& n = plane.normal;
    const float d = plane.d;
    for (LaneMask groups = groups_of(seen[i].rays); groups != 0; groups &= groups - 1) {
      const int g = std::countr_zero(groups);
      const FloatLanes &x = walk.block->direction[0][g], &y = walk.block->direction[1][g],
                       &z = walk.block->direction[2][g];
      const FloatLanes v = 0.0f + ((n.x * x + n.y * y) + n.z * z);
      FloatLanes point[3] = {d * x / v, d * y / v, d * z / v};
      IntLanes v_bits, grazing, error_bits;
      bits_of(v, v_bits);
      grazing_of(plane, v_bits, grazing);
      point_error_of(plane, v_bits, grazing, error_bits);
      FloatLanes error;
      floats_of(error_bits, error);
      for (FloatLanes& p : point) {
        const IntLanes nan = IntLanes{} + 0x7FC00000;
        p = p == p ? p : reinterpret_cast<FloatLanes>(nan);
      }
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
