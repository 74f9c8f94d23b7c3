// Core intersector: sends rays to a ray core, hardware that traverses the tree by itself.
#pragma once

#include <memory>
#include <vector>

#include "host/bvh/bvh.h"
#include "host/intersect/core/core_unit.h"
#include "host/intersect/core/memory_image.h"
#include "host/intersect/intersector.h"

namespace raygate {

/// Exact arithmetic resolves what the core leaves open: with a core that is_exact nothing but which
/// hit is nearer of a ray that went on where a stack had no room. P is computed once for each
/// nearest hit, from a record that the host makes, so that it has the bits of the other
/// intersectors'. Throws InputError where the core reads a line that memory lacks, or a node that
/// is below itself.
class CoreIntersector : public Intersector {
 public:
  /// `image`, of `bvh`, is what the core reads. The tree must outlive this. Intersectors of one
  /// thread may share a core.
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
