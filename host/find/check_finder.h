// Two finders side by side: the first answer in which they differ stops the run.
#pragma once

#include <memory>
#include <stdexcept>
#include <vector>

#include "host/find/finder.h"

namespace raygate {

/// What CheckFinder throws. Its text is one line with the ray, ready to replay (origin, direction
/// and limit in hex), and what each finder made of it.
class FinderMismatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Asks both finders everything, gives the first one's answers and counts, and throws
/// FinderMismatch at the first ray of which they say different things: another triangle, another
/// bit of P or of its error, or intervals of t that cannot both hold the truth. Of a ray that may
/// end at any hit before some t, both must say that there is one.
class CheckFinder : public Finder {
 public:
  CheckFinder(const Bvh& bvh, std::unique_ptr<Finder> finder, std::unique_ptr<Finder> reference);

  void find(std::span<const Ray> rays, const Search& search, std::span<NearestHit> hits) override;
  [[nodiscard]] std::size_t preferred_batch() const override { return finder_->preferred_batch(); }
  [[nodiscard]] FindCounters counters() const override { return finder_->counters(); }

 private:
  [[nodiscard]] bool agree(const Ray& ray, const Search& search, std::size_t number,
                           const NearestHit& a, const NearestHit& b) const;

  const Bvh& bvh_;
  std::unique_ptr<Finder> finder_, reference_;
  std::vector<NearestHit> expected_;
};

}  // namespace raygate
