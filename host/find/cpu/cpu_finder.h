// Hits found in place: corners against rays, without records, batches or a unit.
#pragma once

#include "host/find/finder.h"

namespace raygate {

/// Rays of a common origin go as cones of 64 (ConeSearch), others one by one (RaySearch). P has the
/// bits of the hit-test unit's: computed once for each hit that is found.
class CpuFinder : public Finder {
 public:
  /// The tree must outlive this.
  explicit CpuFinder(const Bvh& bvh) : bvh_(bvh) {}

  void find(std::span<const Ray> rays, const Search& search, std::span<NearestHit> hits) override;
  [[nodiscard]] FindCounters counters() const override { return counters_; }

 private:
  const Bvh& bvh_;
  FindCounters counters_;
};

}  // namespace raygate
