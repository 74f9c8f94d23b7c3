// Core intersector: sends rays to a ray core, hardware that traverses the tree by itself.
#pragma once

#include <memory>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/intersect/core/core_unit.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/intersector.h"

namespace raygate {

/// Exact arithmetic on the host resolves the doubts of the core; a core that is_exact leaves only
/// the comparison of hits of a ray whose stack overflowed. P is computed on the host for each
/// nearest hit, with the same bits as in other intersectors. Throws InputError if the core reads a
/// line that the memory does not have, or a node below itself.
class CoreIntersector : public Intersector {
 public:
  /// `image`: the memory image of `bvh`. The tree must outlive this. Intersectors of one thread can
  /// share a core.
  CoreIntersector(const Bvh& bvh, std::shared_ptr<const MemoryImage> image,
                  std::shared_ptr<CoreUnit> core)
      : bvh_(bvh), image_(std::move(image)), core_(std::move(core)) {}

  void intersect(std::span<const Ray> rays, const RayQuery& query,
                 std::span<NearestHit> hits) override;
  [[nodiscard]] bool wants_sources() const override { return true; }
  [[nodiscard]] IntersectCounters counters() const override;

 private:
  void resolve(const Ray& ray, const RayQuery& query, const CoreResult& result, NearestHit& best);

  const Bvh& bvh_;
  std::shared_ptr<const MemoryImage> image_;
  std::shared_ptr<CoreUnit> core_;
  IntersectCounters counters_;
  std::vector<CoreRay> sent_;
  std::vector<CoreResult> results_;
};

}  // namespace raygate
