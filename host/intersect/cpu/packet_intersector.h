// Packet intersector: rays of one origin, traversed in packets of up to 64 with bounding cones.
#pragma once

#include <cstdint>
#include <span>

#include "host/bvh/bvh.h"
#include "host/intersect/cpu/cone_traversal.h"
#include "host/intersect/cpu/quad_test.h"
#include "host/intersect/intersector.h"

namespace raygate {

/// The part of CpuIntersector for rays with a common origin. A packet has eight groups of eight
/// rays, each with a bounding cone. At a leaf the packet computes a QuadRecord in float32 and tests
/// it against the groups whose cones it meets. Exact arithmetic resolves doubts of float32.
class PacketIntersector {
 public:
  PacketIntersector(const Bvh& bvh, IntersectCounters& counters) : bvh_(bvh), counters_(counters) {}

  /// Intersects as Intersector::intersect does, but always culls. All rays start at the origin of
  /// the first one; `hits` are initialised to misses.
  void trace(std::span<const Ray> rays, const RayQuery& query, std::span<NearestHit> hits);

 private:
  struct SeenPlanes;

  void begin(ConeTraversal& walk) const;
  void traverse(ConeTraversal& walk);
  void finish(const ConeTraversal& walk);
  template <Vectors kCode>
  void test_groups(ConeTraversal& walk, const QuadRecord& record, const Bvh::Child& leaf,
                   LaneMask there, std::uint64_t rays, LaneMask& changed);
  void test_rays(ConeTraversal& walk, const QuadRecord& record, const Bvh::Child& leaf,
                 LaneMask there, std::uint64_t rays, LaneMask& changed);
  void resolve_sides(const Bvh::Child& leaf, QuadRecord& record, LaneMask& there) const;
  bool resolve(ConeTraversal& walk, int group, int lane, std::int32_t primitive,
               const Interval* sure);
  void put(const ConeTraversal& walk, std::uint64_t rays);
  void put_work(const ConeTraversal& walk);
  void find_planes(const ConeTraversal& walk, std::uint64_t rays, SeenPlanes& planes) const;
  void put_with_points(const ConeTraversal& walk, std::uint64_t rays);

  const Bvh& bvh_;
  IntersectCounters& counters_;
  glm::vec3 origin_{0.0f};
  std::span<const Ray> rays_;
  RayQuery query_;
  std::span<NearestHit> hits_;
};

}  // namespace raygate
