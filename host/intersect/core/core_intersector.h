// Core intersector: sends rays to a ray core, hardware that traverses the BVH.
#pragma once

#include <memory>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/intersect/core/core_unit.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/intersector.h"

namespace raygate {

/// Resolves the core's doubts by exact arithmetic on the host. A core that is_exact leaves only the
/// comparison of hits of a ray whose stack overflowed. The host computes P of each nearest hit,
/// with the same bits as in other intersectors. Throws InputError if the core reads a line that the
/// memory does not have, or a node below itself.
class CoreIntersector : public Intersector {
 public:
  /// `image` is the memory image of `bvh`, which must outlive this object. Intersectors of one
  /// thread can share a core.
  CoreIntersector(const Bvh& bvh, std::shared_ptr<const MemoryImage> image,
                  std::shared_ptr<CoreUnit> core)
      : Intersector({.wants_sources = true}),
        bvh_(bvh),
        image_(std::move(image)),
        core_(std::move(core)) {}

  [[nodiscard]] IntersectCounters counters() const override;

 private:
  void trace(std::span<const Ray> rays, const RayQuery& query, std::span<NearestHit> hits) override;
  void resolve(const Ray& ray, float t_max, const CoreResult& result, NearestHit& best);

  const Bvh& bvh_;
  std::shared_ptr<const MemoryImage> image_;
  std::shared_ptr<CoreUnit> core_;
  IntersectCounters counters_;
  std::vector<CoreRay> sent_;
  std::vector<CoreResult> results_;
};

}  // namespace raygate
