// Rays of one origin, tested in place: cones of up to 64 rays walk the tree as one.
#pragma once

#include <cstdint>
#include <span>

#include "host/bvh/bvh.h"
#include "host/intersect/cpu/cone_traversal.h"
#include "host/intersect/cpu/quad_record.h"
#include "host/intersect/intersector.h"

namespace raygate {

/// A part of CpuIntersector, for rays of one origin. What is needed of polygon records is made in
/// float32 when a cone comes to a leaf, and tested while it is at hand, against those of eight
/// groups of eight rays whose cone it meets at all. What float32 leaves open exact arithmetic
/// settles: decisions are the same, whatever decides first.
class PacketIntersector {
 public:
  PacketIntersector(const Bvh& bvh, IntersectCounters& counters) : bvh_(bvh), counters_(counters) {}

  /// As Intersector::find, but always culling. All rays begin at the first one's origin; `hits` are
  /// empty.
  void trace(std::span<const Ray> rays, const RayQuery& query, std::span<NearestHit> hits);

 private:
  /// A triangle that is the nearest hit of some rays.
  struct Seen {
    std::uint32_t primitive;
    std::uint64_t rays;
  };

  friend void begin(const PacketIntersector& intersector, ConeTraversal& walk);
  friend void walk_tree(PacketIntersector& intersector, ConeTraversal& walk);
  friend void finish(PacketIntersector& intersector, const ConeTraversal& walk);

  template <Vectors kCode>
  void test_groups(ConeTraversal& walk, const QuadRecord& record, const Bvh::Child& leaf,
                   LaneMask there, std::uint64_t rays, LaneMask& changed);
  void test_rays(ConeTraversal& walk, const QuadRecord& record, const Bvh::Child& leaf,
                 LaneMask there, std::uint64_t rays, LaneMask& changed);
  void resolve_sides(const Bvh::Child& leaf, QuadRecord& record, LaneMask& there) const;
  bool resolve(ConeTraversal& walk, int group, int lane, std::int32_t primitive,
               const Interval* sure);
  void put(const ConeTraversal& walk, const Seen& seen);
  void put_work(const ConeTraversal& walk);
  void put_with_points(const ConeTraversal& walk, std::span<const Seen> seen);

  const Bvh& bvh_;
  IntersectCounters& counters_;
  glm::vec3 origin_{0.0f};
  std::span<const Ray> rays_;
  RayQuery query_;
  std::span<NearestHit> hits_;
};

}  // namespace raygate
