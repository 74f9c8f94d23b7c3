// Hits found by a ray core: rays go to hardware that walks the tree by itself.
#pragma once

#include <memory>
#include <vector>

#include "host/find/core/core_unit.h"
#include "host/find/core/memory_image.h"
#include "host/find/finder.h"
#include "host/tree/bvh.h"

namespace raygate {

/// Sends rays to a core and settles by exact arithmetic what it leaves open. P is the hit-test
/// unit's, from a record that the host makes, once for each hit: so that it has the bits of other
/// finders'.
class CoreFinder : public Finder {
 public:
  /// `image`, of `bvh`, is what the core reads. The tree must outlive this. Finders of one thread
  /// may share a core.
  CoreFinder(const Bvh& bvh, std::shared_ptr<const MemoryImage> image,
             std::shared_ptr<CoreUnit> core)
      : bvh_(bvh), image_(std::move(image)), core_(std::move(core)) {}

  void find(std::span<const Ray> rays, const Search& search, std::span<NearestHit> hits) override;
  [[nodiscard]] FindCounters counters() const override;

 private:
  void settle(const Ray& ray, const Search& search, const CoreResult& result, NearestHit& best);

  const Bvh& bvh_;
  std::shared_ptr<const MemoryImage> image_;
  std::shared_ptr<CoreUnit> core_;
  FindCounters counters_;
  std::vector<CoreRay> sent_;
  std::vector<CoreResult> results_;
};

}  // namespace raygate
